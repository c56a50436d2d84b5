// SPDX-License-Identifier: MIT OR Apache-2.0
//! The player of a script: it drives the cycle-level model clock by clock, and records the result.

use super::core_simulation::CoreSimulation;
use super::delivery::BenchDelivery;
use super::script::{BenchFrame, BenchScript, BenchSequence, BenchSequenceEnd, BenchSinkMode};
use super::vector_recorder::VectorRecorder;
use crate::error::CosimError;
use foveate_design::Design;
use foveate_emit::Top;
use foveate_model::{CoreInput, ThresholdInputs};
use foveate_toolchain::ToolError;
use std::sync::atomic::{AtomicBool, Ordering};

/// The number of pixels of a frame that a reset discards.
const DISCARDED_BEATS: usize = 3;
/// The period of pauses, in beats. Long frames have fewer pauses, because a pause takes two lines
/// of the vectors.
const PAUSE_PERIOD: usize = 29;
const LONG_FRAME_PAUSE_PERIOD: usize = 997;
const LONG_FRAME_BEATS: usize = 20_000;
/// The number of clocks after a frame at which pixels are offered that a busy array must not take.
const REFUSED_CLOCKS: usize = 3;

/// The number of clocks between two frames after which no window has flushed: the smallest window
/// has four pixels.
const CLOCKS_WITHIN_FLUSH: u64 = 2;
/// The number of clocks that a word waits for a sink that delays words.
const SINK_DELAY: u32 = 2;
/// The largest number of clocks to wait for a pixel or mean to leave.
const MAX_WAIT_CLOCKS: usize = 1 << 20;

/// A player of scripts.
pub(super) struct ScriptPlayer<'a> {
    simulation: CoreSimulation<'a>,
    recorder: &'a mut VectorRecorder,
    cancel: &'a AtomicBool,
    /// The pixels at the port while they mean nothing.
    garbage: Vec<u16>,
    sink: BenchSinkMode,
    /// The number of clocks that a word has waited for a sink that delays words.
    waited_clocks: u32,
    /// True if a frame waits for the sink, which must then not stall between frames.
    frames_wait_for_sink: bool,
}

impl<'a> ScriptPlayer<'a> {
    pub(super) fn new(
        part: &'a Design,
        top: Top,
        tape: &'a mut VectorRecorder,
        cancel: &'a AtomicBool,
    ) -> Self {
        let rig = CoreSimulation::new(part, top);
        let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
        let waits = part.timing().departure().buffered_rows.is_none();
        Self {
            garbage: vec![max; rig.beat_width()],
            simulation: rig,
            recorder: tape,
            cancel,
            sink: BenchSinkMode::AlwaysReady,
            waited_clocks: 0,
            frames_wait_for_sink: waits,
        }
    }

    /// Plays all sequences. The first sequence begins twice: a reset discards the first attempt.
    pub(super) fn play(&mut self, script: &BenchScript) -> Result<(), CosimError> {
        for (number, sequence) in script.sequences.iter().enumerate() {
            let Some(first) = sequence.frames.first() else { continue };
            if number == 0 {
                self.reset(first)?;
                let beats = self.simulation.beats(&first.frame);
                self.send_frame(&beats[..DISCARDED_BEATS.min(beats.len())], &first.thresholds)?;
            }
            self.reset(first)?;
            self.play_sequence(sequence)?;
        }
        if self.recorder.has_frame_sync() {
            self.play_damaged(&script.damaged)?;
        }
        Ok(())
    }

    /// Plays damaged frames, and the whole frames behind them.
    fn play_damaged(&mut self, shots: &[BenchFrame]) -> Result<(), CosimError> {
        let (Some(first), Some(last)) = (shots.first(), shots.last()) else { return Ok(()) };
        self.sink = BenchSinkMode::AlwaysReady;
        self.reset(first)?;
        for (shot, delivery) in shots.iter().zip(BenchDelivery::ALL) {
            let beats = self.simulation.beats(&shot.frame);
            for (sof, pixels) in delivery.delivered_beats(&beats, &self.garbage.clone()) {
                self.send_beat(pixels, sof, &shot.thresholds)?;
            }
        }
        self.drain(last)
    }

    fn reset(&mut self, shot: &BenchFrame) -> Result<(), CosimError> {
        let garbage = self.garbage.clone();
        for valid in [true, false] {
            let applied = CoreInput::idle(&garbage, &shot.thresholds);
            self.clock(&CoreInput { reset: true, valid, ..applied })?;
        }
        Ok(())
    }

    fn play_sequence(&mut self, sequence: &BenchSequence) -> Result<(), CosimError> {
        if sequence.ending == BenchSequenceEnd::Leaving {
            return self.play_until_leaving(&sequence.frames);
        }
        let mut before: Option<&BenchFrame> = None;
        for (number, shot) in sequence.frames.iter().enumerate() {
            if let Some(before) = before {
                // A decision is made with the thresholds of its own clock.
                let is_new = before.thresholds != shot.thresholds;
                self.settle_between_frames(&before.thresholds, is_new || number % 3 == 0)?;
                // In turn, a frame follows at once, after everything has settled, and while windows
                // flush.
                if number % 3 == 2 {
                    self.idle(CLOCKS_WITHIN_FLUSH, &before.thresholds)?;
                }
            }
            let beats = self.simulation.beats(&shot.frame);
            self.sink = shot.sink;
            self.send_frame(&beats, &shot.thresholds)?;
            before = Some(shot);
        }
        match (before, sequence.ending) {
            (Some(last), BenchSequenceEnd::Drained) => self.drain(last),
            (Some(last), BenchSequenceEnd::MeanLeaving)
                if self.simulation.distinguishes_means() =>
            {
                self.wait_until_leaving(last, true)
            }
            (Some(last), BenchSequenceEnd::MeanLeaving | BenchSequenceEnd::Leaving) => {
                self.drain(last)
            }
            (None, _) => Ok(()),
        }
    }

    /// Plays frames up to the first pixel that leaves.
    fn play_until_leaving(&mut self, shots: &[BenchFrame]) -> Result<(), CosimError> {
        for shot in shots {
            self.sink = shot.sink;
            for (number, pixels) in self.simulation.beats(&shot.frame).iter().enumerate() {
                self.send_beat(pixels, number == 0, &shot.thresholds)?;
                if self.simulation.is_sending() {
                    return Ok(());
                }
            }
        }
        shots.last().map_or(Ok(()), |last| self.wait_until_leaving(last, false))
    }

    /// Continues until a pixel or a mean leaves, for `MAX_WAIT_CLOCKS` clocks at most. If that
    /// needs another frame, the same one is played again.
    fn wait_until_leaving(&mut self, last: &BenchFrame, is_mean: bool) -> Result<(), CosimError> {
        let (beats, thresholds) = (self.simulation.beats(&last.frame), &last.thresholds);
        let frames = self.simulation.frames_behind();
        // A core with a `ready` output has sent everything by the time it is ready.
        if frames > 0 {
            self.settle_between_frames(thresholds, true)?;
        }
        let mut left = (0..frames).flat_map(|_| beats.iter().enumerate());
        for _ in 0..MAX_WAIT_CLOCKS {
            let has_left = match is_mean {
                true => self.simulation.is_sending_mean(),
                false => self.simulation.is_sending(),
            };
            if has_left {
                break;
            }
            match (left.next(), self.simulation.quiet_clocks()) {
                (Some((number, pixels)), _) => self.send_beat(pixels, number == 0, thresholds)?,
                (None, 0 | 1) => self.idle(1, thresholds)?,
                (None, quiet) => self.skip_quiet_clocks(quiet, thresholds)?,
            }
        }
        Ok(())
    }

    fn send_frame(
        &mut self,
        beats: &[Vec<u16>],
        thresholds: &ThresholdInputs,
    ) -> Result<(), CosimError> {
        let every =
            if beats.len() < LONG_FRAME_BEATS { PAUSE_PERIOD } else { LONG_FRAME_PAUSE_PERIOD };
        let every = every.min(beats.len());
        for (number, pixels) in beats.iter().enumerate() {
            if number % every == every - 1 {
                self.idle(1, thresholds)?;
            }
            self.send_beat(pixels, number == 0, thresholds)?;
        }
        Ok(())
    }

    /// Plays one beat as soon as the core takes it; `sof` marks the first beat of a frame.
    fn send_beat(
        &mut self,
        pixels: &[u16],
        sof: bool,
        thresholds: &ThresholdInputs,
    ) -> Result<(), CosimError> {
        self.wait_until_ready(thresholds)?;
        self.clock(&CoreInput { sof, ..CoreInput::valid(pixels, thresholds) })
    }

    /// Plays the time between two frames. Pixels that are offered while the core is busy are
    /// refused. With `is_long` everything is decided before the next frame.
    fn settle_between_frames(
        &mut self,
        thresholds: &ThresholdInputs,
        is_long: bool,
    ) -> Result<(), CosimError> {
        if self.frames_wait_for_sink && self.sink == BenchSinkMode::Stalling {
            self.sink = BenchSinkMode::AlwaysReady;
        }
        let garbage = self.garbage.clone();
        for _ in 0..REFUSED_CLOCKS {
            if !self.simulation.is_ready() {
                self.clock(&CoreInput::valid(&garbage, thresholds))?;
            }
        }
        self.wait_until_ready(thresholds)?;
        if is_long {
            self.idle(self.simulation.settling_clocks(), thresholds)?;
        }
        Ok(())
    }

    /// Waits until all pixels have left.
    fn drain(&mut self, last: &BenchFrame) -> Result<(), CosimError> {
        self.settle_between_frames(&last.thresholds, true)?;
        let beats = self.simulation.beats(&last.frame);
        for _ in 0..self.simulation.frames_behind() {
            self.send_frame(&beats, &last.thresholds)?;
            self.settle_between_frames(&last.thresholds, true)?;
        }
        self.idle(2, &last.thresholds)
    }

    /// Waits until a pixel can be taken.
    fn wait_until_ready(&mut self, thresholds: &ThresholdInputs) -> Result<(), CosimError> {
        while !self.simulation.is_ready() {
            match self.simulation.quiet_clocks() {
                0 | 1 => self.idle(1, thresholds)?,
                quiet => self.skip_quiet_clocks(quiet, thresholds)?,
            }
        }
        Ok(())
    }

    fn idle(&mut self, clocks: u64, thresholds: &ThresholdInputs) -> Result<(), CosimError> {
        let garbage = self.garbage.clone();
        for _ in 0..clocks {
            // A start mark without a valid pixel means nothing.
            self.clock(&CoreInput { sof: true, ..CoreInput::idle(&garbage, thresholds) })?;
        }
        Ok(())
    }

    fn clock(&mut self, applied: &CoreInput<'_>) -> Result<(), CosimError> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(ToolError::Interrupted.into());
        }
        let forward_ready = match self.sink {
            BenchSinkMode::AlwaysReady => true,
            BenchSinkMode::Stalling => self.simulation.is_stalling_sink_ready(),
            BenchSinkMode::Delaying => self.is_delayed_sink_ready(),
        };
        let applied = CoreInput { forward_ready, ..*applied };
        self.simulation.clock(&applied, &mut self.recorder.record);
        self.recorder.push(1)
    }

    /// Returns true if a word has waited long enough.
    fn is_delayed_sink_ready(&mut self) -> bool {
        self.waited_clocks = if self.simulation.is_sending() { self.waited_clocks + 1 } else { 0 };
        let takes = self.waited_clocks > SINK_DELAY;
        if takes {
            self.waited_clocks = 0;
        }
        takes
    }

    fn skip_quiet_clocks(
        &mut self,
        clocks: u64,
        thresholds: &ThresholdInputs,
    ) -> Result<(), CosimError> {
        let applied = CoreInput::idle(&self.garbage, thresholds);
        self.simulation.skip_quiet_clocks(&applied, &mut self.recorder.record);
        self.recorder.push(clocks)
    }
}
