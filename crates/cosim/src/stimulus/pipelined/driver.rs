// SPDX-License-Identifier: MIT OR Apache-2.0
//! Streams frames into the model, clock by clock, and records what goes in and what comes out.

use super::super::aim::Ranges;
use super::super::applied::Applied;
use super::super::damage::Delivery;
use super::super::random::Random;
use super::super::sequence::{Gaps, PipelinedAim};
use super::machine::{Machine, PipelinedCodec};
use crate::error::CosimError;
use crate::recording::Recorder;
use foveate_design::{PipelinedDesign, Thresholds as Mode};
use foveate_model::{FrameSync, PipelinedRpu, RpuInput, RpuOutput, Thresholds};
use foveate_toolchain::ToolError;
use std::sync::atomic::{AtomicBool, Ordering};

/// Streams frames into the model.
pub(crate) struct Driver<'a> {
    machine: Machine,
    /// An RPU of its own, which tells when a decision comes: it is the same clock in every lane.
    scout: PipelinedRpu,
    /// What stands in front of the scout, where that is in front of the lanes.
    sync: Option<FrameSync>,
    cancel: &'a AtomicBool,
    recorder: &'a mut Recorder,
    codec: PipelinedCodec,
    pub(crate) ranges: Ranges,
    pub(crate) random: Random,
    /// Thresholds as they are now.
    pub(crate) thresholds: Thresholds,
    configured: Thresholds,
    constant: bool,
    aim: PipelinedAim,
    /// How often levels have been aimed since the sequence began.
    turn: u32,
    border: u8,
    max: u16,
    garbage: Vec<u16>,
    input: Vec<u8>,
    expected: Vec<u8>,
    outputs: Vec<RpuOutput>,
}

impl<'a> Driver<'a> {
    pub(crate) fn new(
        design: PipelinedDesign<'_>,
        machine: Machine,
        lanes: usize,
        recorder: &'a mut Recorder,
        random: Random,
        cancel: &'a AtomicBool,
    ) -> Self {
        let configured = Thresholds::of(&design);
        let sync = design.syncs() && matches!(machine, Machine::Rcm(_));
        Self {
            sync: sync.then(|| FrameSync::new(&design)),
            machine,
            scout: PipelinedRpu::new(design),
            cancel,
            input: recorder.inputs().record(),
            expected: recorder.outputs().record(),
            recorder,
            codec: PipelinedCodec::new(design),
            ranges: Ranges::of(&design),
            random,
            thresholds: configured,
            configured,
            constant: design.thresholds() == Mode::Constant,
            aim: PipelinedAim::Design,
            turn: 0,
            border: 0,
            max: u16::try_from(design.pixel_max()).expect("a pixel has at most 16 bits"),
            garbage: vec![0; lanes],
            outputs: Vec::with_capacity(lanes),
        }
    }

    /// Starts over: a reset, during which anything may be on the other inputs.
    pub(crate) fn begin(&mut self, aim: PipelinedAim, border: u8) -> Result<(), CosimError> {
        self.aim = if self.constant { PipelinedAim::Design } else { aim };
        self.turn = 0;
        self.border = border;
        self.thresholds = self.configured;
        for _ in 0..=self.random.up_to(1) {
            let valid = self.random.one_in(2);
            self.shuffle_garbage();
            self.clock(true, valid, None, None)?;
        }
        Ok(())
    }

    /// Whether the thresholds are those of the design, so that the data must meet them.
    pub(crate) fn thresholds_are_configured(&self) -> bool {
        self.aim == PipelinedAim::Design
    }

    /// Names the clocks from here on.
    pub(crate) fn name(&mut self, sequence: &str, frame: u64, region: Option<u32>) {
        self.recorder.begin_frame(sequence, frame, region);
    }

    /// Levels for the frame that comes.
    pub(crate) fn aim_levels(&mut self, now: &[u16], before: &[u16]) {
        match self.aim {
            PipelinedAim::Exact => {
                self.ranges.aim_levels(now, before, &mut self.thresholds, &mut self.random);
            }
            PipelinedAim::Largest => {
                self.ranges.aim_largest_levels(self.turn, &mut self.thresholds);
            }
            PipelinedAim::Design | PipelinedAim::Restless => {}
        }
        self.turn += 1;
    }

    /// The first `count` pixels of a frame; `streams` holds one stream per lane, one after the other.
    pub(crate) fn stream(
        &mut self,
        streams: &[u16],
        count: usize,
        gaps: Gaps,
    ) -> Result<(), CosimError> {
        let lanes = self.garbage.len();
        let length = streams.len() / lanes;
        let mut pixels = vec![0; lanes];
        for at in 0..count.min(length) {
            let pause = gaps.before_pixel(&mut self.random);
            self.idle(pause)?;
            for (pixel, stream) in pixels.iter_mut().zip(streams.chunks_exact(length)) {
                *pixel = stream[at];
            }
            self.clock(false, true, Some(at == 0), Some(&pixels))?;
        }
        Ok(())
    }

    /// What comes of a frame on its way; `streams` as for [`Self::stream`].
    pub(crate) fn deliver(
        &mut self,
        streams: &[u16],
        delivery: Delivery,
        gaps: Gaps,
    ) -> Result<(), CosimError> {
        let length = streams.len() / self.garbage.len();
        for (sof, place) in delivery.beats(length, &mut self.random) {
            let pause = gaps.before_pixel(&mut self.random);
            self.idle(pause)?;
            self.shuffle_garbage();
            let beat = place
                .map(|at| streams.iter().skip(at).step_by(length).copied().collect::<Vec<_>>());
            self.clock(false, true, Some(sof), beat.as_deref())?;
        }
        Ok(())
    }

    /// Whether the lanes are behind something that finds their frames.
    pub(crate) fn finds_frames(&self) -> bool {
        self.sync.is_some()
    }

    /// Clocks without a pixel; the pixel port shows anything.
    pub(crate) fn idle(&mut self, clocks: u64) -> Result<(), CosimError> {
        for _ in 0..clocks {
            self.shuffle_garbage();
            self.clock(false, false, None, None)?;
        }
        Ok(())
    }

    fn shuffle_garbage(&mut self) {
        for pixel in &mut self.garbage {
            *pixel = self.random.pixel(self.max);
        }
    }

    /// One edge. Without pixels the garbage is applied, and without a mark any.
    fn clock(
        &mut self,
        reset: bool,
        valid: bool,
        sof: Option<bool>,
        pixels: Option<&[u16]>,
    ) -> Result<(), CosimError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(ToolError::Interrupted.into());
        }
        if self.aim == PipelinedAim::Restless {
            self.ranges.shake(&mut self.thresholds, &mut self.random);
        }
        let sof = sof.unwrap_or_else(|| self.sync.is_some() && self.random.one_in(2));
        let pixels = pixels.unwrap_or(&self.garbage);
        let mut inputs = Applied {
            reset,
            valid,
            sof,
            border: self.border,
            ..Applied::idle(pixels, &self.thresholds)
        };
        if self.aim != PipelinedAim::Design {
            let lane = self.random.up_to(self.garbage.len().saturating_sub(1) as u64);
            if decides(&mut self.scout, self.sync.as_mut(), &inputs) {
                // What is decided after this edge does not depend on the minima of this edge, so that
                // a copy can look ahead; it is made here alone, because an array is large.
                self.machine.clone().step(&inputs, &mut self.outputs);
                let lane = usize::try_from(lane).expect("it is a lane");
                if let Some(output) = self.outputs.get(lane) {
                    let (scores, count) = (&output.scores, output.temporal_count);
                    self.ranges.aim_minima(scores, count, &mut self.thresholds, &mut self.random);
                    inputs.thresholds = self.thresholds;
                }
            }
        }
        let sync_error = self.machine.step(&inputs, &mut self.outputs);
        self.codec.inputs(self.recorder.inputs(), &inputs, &mut self.input);
        let layout = self.recorder.outputs();
        self.codec.outputs(layout, &self.outputs, sync_error, &mut self.expected);
        self.recorder.push(&self.input, &self.expected)
    }
}

/// Whether a decision is there after this edge. The scout must take every edge of a sequence; it takes
/// none of those whose thresholds are not aimed, and the reset that begins a sequence brings it back
/// into step. Neither pixels nor borders nor thresholds move a decision in time.
fn decides(scout: &mut PipelinedRpu, sync: Option<&mut FrameSync>, inputs: &Applied<'_>) -> bool {
    let &Applied { reset, valid, sof, border, pixels, ref thresholds, .. } = inputs;
    let valid = match sync {
        None => valid,
        Some(sync) if reset => {
            sync.reset();
            false
        }
        Some(sync) => sync.step(valid, sof, true),
    };
    scout.step(&RpuInput { reset, valid, pixel: pixels[0], border }, thresholds).decision_valid
}
