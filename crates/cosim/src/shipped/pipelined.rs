// SPDX-License-Identifier: MIT OR Apache-2.0
//! One RPU or an array of them: a pixel of every region at every clock, back to back.

use super::model::{Model, Record};
use crate::stimulus::{Applied, Machine, PipelinedCodec};
use foveate_design::{PipelinedDesign, PipelinedTiming};
use foveate_emit::Top;
use foveate_frame::Frame;
use foveate_model::{PipelinedRcm, PipelinedRpu, RpuOutput, region_stream};

/// The only region of an array of one is at the frame's border on all sides.
const ALL_SIDES: u8 = 0b1111;

pub(super) fn model(part: PipelinedDesign<'_>, top: Top) -> Box<dyn Model + '_> {
    let machine = match top {
        Top::Rpu => Machine::Rpu(Box::new(PipelinedRpu::new(part))),
        Top::Rcm => Machine::Rcm(PipelinedRcm::new(part)),
    };
    Box::new(Pipelined {
        machine,
        codec: PipelinedCodec::new(part),
        timing: PipelinedTiming::of(part),
        part,
        shown: Vec::new(),
    })
}

struct Pipelined<'a> {
    machine: Machine,
    codec: PipelinedCodec,
    timing: PipelinedTiming,
    part: PipelinedDesign<'a>,
    shown: Vec<RpuOutput>,
}

impl Model for Pipelined<'_> {
    fn width(&self) -> usize {
        self.part.regions() as usize
    }

    fn beats(&self, frame: &Frame) -> Vec<Vec<u16>> {
        let part = self.part;
        let mut streams = Vec::new();
        for region in 0..part.regions() {
            region_stream(&part, frame, region, &mut streams);
        }
        let length = part.stream_pixels() as usize;
        let beat = |at| streams.iter().skip(at).step_by(length).copied().collect();
        (0..length).map(beat).collect()
    }

    fn clock(&mut self, applied: &Applied<'_>, record: &mut Record) {
        let applied = Applied { border: ALL_SIDES, ..*applied };
        let sync_error = self.machine.step(&applied, &mut self.shown);
        self.codec.inputs(&record.inputs, &applied, &mut record.input);
        self.codec.outputs(&record.outputs, &self.shown, sync_error, &mut record.expected);
    }

    fn quiet_clocks(&self) -> u64 {
        0
    }

    fn is_ready(&self) -> bool {
        true
    }

    fn settling_clocks(&self) -> u64 {
        u64::from(self.timing.decision_latency) + 4
    }

    fn frames_behind(&self) -> u32 {
        self.timing.forward_frames
    }
}
