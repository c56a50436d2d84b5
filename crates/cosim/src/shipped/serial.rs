// SPDX-License-Identifier: MIT OR Apache-2.0
//! A serial array: it takes a frame, works on it, and is ready again when everything has left.

use super::model::{Model, Record};
use crate::stimulus::{Applied, Feed, SerialCodec};
use foveate_design::SerialDesign;
use foveate_frame::Frame;
use foveate_model::SerialRcm;

pub(super) fn model(part: SerialDesign<'_>) -> Box<dyn Model + '_> {
    Box::new(Serial { part, array: SerialRcm::new(part), codec: SerialCodec::new(part) })
}

struct Serial<'a> {
    part: SerialDesign<'a>,
    array: SerialRcm,
    codec: SerialCodec,
}

impl Model for Serial<'_> {
    fn width(&self) -> usize {
        self.array.output().forward_valid.len()
    }

    fn beats(&self, frame: &Frame) -> Vec<Vec<u16>> {
        Feed::of(self.part, frame, || 0).beats().map(<[u16]>::to_vec).collect()
    }

    fn clock(&mut self, applied: &Applied<'_>, record: &mut Record) {
        let shown = self.array.step(&applied.of_array());
        self.codec.inputs(&record.inputs, applied, &mut record.input);
        self.codec.outputs(&record.outputs, shown, &mut record.expected);
    }

    fn skip(&mut self, applied: &Applied<'_>, record: &mut Record) {
        let shown = self.array.skip(self.array.quiet_clocks());
        self.codec.inputs(&record.inputs, applied, &mut record.input);
        self.codec.outputs(&record.outputs, shown, &mut record.expected);
    }

    fn quiet_clocks(&self) -> u64 {
        self.array.quiet_clocks()
    }

    fn is_ready(&self) -> bool {
        self.array.output().ready
    }

    fn settling_clocks(&self) -> u64 {
        0
    }

    fn frames_behind(&self) -> u32 {
        0
    }
}
