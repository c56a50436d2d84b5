// SPDX-License-Identifier: MIT OR Apache-2.0
//! A raster core in front of a sink: decisions and pixels leave while a frame is taken.

use super::model::{Model, Record};
use crate::stimulus::{Applied, RasterCodec, words};
use foveate_design::Design;
use foveate_emit::Top;
use foveate_frame::Frame;
use foveate_model::RasterRcm;

pub(super) fn model(part: &Design, _: Top) -> Box<dyn Model> {
    let departure = part.timing().departure();
    Box::new(Raster {
        core: RasterRcm::new(part),
        codec: RasterCodec::new(part),
        word_pixels: part.pixels_per_clock() as usize,
        settling: departure.decision_clocks.max(departure.forward_clocks),
    })
}

struct Raster {
    core: RasterRcm,
    codec: RasterCodec,
    word_pixels: usize,
    /// Clocks from the last word of a frame until all has left.
    settling: u64,
}

impl Model for Raster {
    fn width(&self) -> usize {
        self.word_pixels
    }

    fn beats(&self, part: &Design, frame: &Frame) -> Vec<Vec<u16>> {
        words(part, frame, || 0)
    }

    fn clock(&mut self, applied: &Applied<'_>, record: &mut Record) {
        let shown = self.core.step(&applied.of_core());
        self.codec.inputs(&record.inputs, applied, &mut record.input);
        self.codec.outputs(&record.outputs, shown, &mut record.expected);
    }

    fn quiet_clocks(&self) -> u64 {
        0
    }

    fn is_ready(&self) -> bool {
        self.core.output().ready
    }

    fn settling_clocks(&self) -> u64 {
        self.settling
    }

    fn frames_behind(&self) -> u32 {
        0
    }
}
