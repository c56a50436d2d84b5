// SPDX-License-Identifier: MIT OR Apache-2.0
//! The player of a script: it drives the cycle-level model clock by clock, and records the result.

use super::damage::Delivery;
use super::rig::Rig;
use super::script::{Ending, Script, Shot, ShotSequence, SinkMood};
use super::tape::Tape;
use crate::error::CosimError;
use foveate_design::Design;
use foveate_emit::Top;
use foveate_model::{CoreInput, Thresholds};
use foveate_toolchain::ToolError;
use std::sync::atomic::{AtomicBool, Ordering};

/// The number of pixels of a frame that a reset discards.
const FORGOTTEN: usize = 3;
/// The period of pauses, in beats. Long frames have fewer pauses, because a pause takes two lines
/// of the vectors.
const PAUSE_EVERY: usize = 29;
const PAUSE_EVERY_OF_MANY: usize = 997;
const MANY_BEATS: usize = 20_000;
/// The number of clocks after a frame at which pixels are offered that a busy array must not take.
const REFUSED: usize = 3;

/// The number of clocks between two frames after which no window has flushed: the smallest window
/// has four pixels.
const WITHIN_A_FLUSH: u64 = 2;
/// The number of clocks that a word waits for a sink that delays words.
const HESITATION: u32 = 2;
/// The largest number of clocks to wait for a pixel or mean to leave.
const MOST_WAITING: usize = 1 << 20;

/// A player of scripts.
pub(super) struct Player<'a> {
    rig: Rig<'a>,
    tape: &'a mut Tape,
    cancel: &'a AtomicBool,
    /// The pixels at the port while they mean nothing.
    garbage: Vec<u16>,
    sink: SinkMood,
    /// The number of clocks that a word has waited for a sink that delays words.
    waited: u32,
    /// True if a frame waits for the sink, which must then not stall between frames.
    waits: bool,
}

impl<'a> Player<'a> {
    pub(super) fn new(
        part: &'a Design,
        top: Top,
        tape: &'a mut Tape,
        cancel: &'a AtomicBool,
    ) -> Self {
        let rig = Rig::new(part, top);
        let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
        let waits = part.timing().departure().kept_rows.is_none();
        Self {
            garbage: vec![max; rig.width()],
            rig,
            tape,
            cancel,
            sink: SinkMood::Willing,
            waited: 0,
            waits,
        }
    }

    /// Plays all sequences. The first sequence begins twice: a reset discards the first attempt.
    pub(super) fn play(&mut self, script: &Script) -> Result<(), CosimError> {
        for (number, sequence) in script.sequences.iter().enumerate() {
            let Some(first) = sequence.shots.first() else { continue };
            if number == 0 {
                self.reset(first)?;
                let beats = self.rig.beats(&first.frame);
                self.stream(&beats[..FORGOTTEN.min(beats.len())], &first.thresholds)?;
            }
            self.reset(first)?;
            self.sequence(sequence)?;
        }
        if self.tape.finds_frames() {
            self.damaged(&script.damaged)?;
        }
        Ok(())
    }

    /// Plays damaged frames, and the whole frames behind them.
    fn damaged(&mut self, shots: &[Shot]) -> Result<(), CosimError> {
        let (Some(first), Some(last)) = (shots.first(), shots.last()) else { return Ok(()) };
        self.sink = SinkMood::Willing;
        self.reset(first)?;
        for (shot, delivery) in shots.iter().zip(Delivery::ALL) {
            let beats = self.rig.beats(&shot.frame);
            for (sof, pixels) in delivery.of(&beats, &self.garbage.clone()) {
                self.beat(pixels, sof, &shot.thresholds)?;
            }
        }
        self.drain(last)
    }

    fn reset(&mut self, shot: &Shot) -> Result<(), CosimError> {
        let garbage = self.garbage.clone();
        for valid in [true, false] {
            let applied = CoreInput::idle(&garbage, &shot.thresholds);
            self.clock(&CoreInput { reset: true, valid, ..applied })?;
        }
        Ok(())
    }

    fn sequence(&mut self, sequence: &ShotSequence) -> Result<(), CosimError> {
        if sequence.ending == Ending::Leaving {
            return self.until_leaving(&sequence.shots);
        }
        let mut before: Option<&Shot> = None;
        for (number, shot) in sequence.shots.iter().enumerate() {
            if let Some(before) = before {
                // A decision is made with the thresholds of its own clock.
                let is_new = before.thresholds != shot.thresholds;
                self.settle(&before.thresholds, is_new || number % 3 == 0)?;
                // In turn, a frame follows at once, after everything has settled, and while windows
                // flush.
                if number % 3 == 2 {
                    self.idle(WITHIN_A_FLUSH, &before.thresholds)?;
                }
            }
            let beats = self.rig.beats(&shot.frame);
            self.sink = shot.sink;
            self.stream(&beats, &shot.thresholds)?;
            before = Some(shot);
        }
        match (before, sequence.ending) {
            (Some(last), Ending::Drained) => self.drain(last),
            (Some(last), Ending::MeanLeaving) if self.rig.tells_means() => self.until(last, true),
            (Some(last), Ending::MeanLeaving | Ending::Leaving) => self.drain(last),
            (None, _) => Ok(()),
        }
    }

    /// Plays frames up to the first pixel that leaves.
    fn until_leaving(&mut self, shots: &[Shot]) -> Result<(), CosimError> {
        for shot in shots {
            self.sink = shot.sink;
            for (number, pixels) in self.rig.beats(&shot.frame).iter().enumerate() {
                self.beat(pixels, number == 0, &shot.thresholds)?;
                if self.rig.sends() {
                    return Ok(());
                }
            }
        }
        shots.last().map_or(Ok(()), |last| self.until(last, false))
    }

    /// Continues until a pixel or a mean leaves, for `MOST_WAITING` clocks at most. If that needs
    /// another frame, the same one is played again.
    fn until(&mut self, last: &Shot, is_mean: bool) -> Result<(), CosimError> {
        let (beats, thresholds) = (self.rig.beats(&last.frame), &last.thresholds);
        let frames = self.rig.frames_behind();
        // A core with a `ready` output has sent everything by the time it is ready.
        if frames > 0 {
            self.settle(thresholds, true)?;
        }
        let mut left = (0..frames).flat_map(|_| beats.iter().enumerate());
        for _ in 0..MOST_WAITING {
            if if is_mean { self.rig.sends_mean() } else { self.rig.sends() } {
                break;
            }
            match (left.next(), self.rig.quiet_clocks()) {
                (Some((number, pixels)), _) => self.beat(pixels, number == 0, thresholds)?,
                (None, 0 | 1) => self.idle(1, thresholds)?,
                (None, quiet) => self.skip(quiet, thresholds)?,
            }
        }
        Ok(())
    }

    fn stream(&mut self, beats: &[Vec<u16>], thresholds: &Thresholds) -> Result<(), CosimError> {
        let every = if beats.len() < MANY_BEATS { PAUSE_EVERY } else { PAUSE_EVERY_OF_MANY };
        let every = every.min(beats.len());
        for (number, pixels) in beats.iter().enumerate() {
            if number % every == every - 1 {
                self.idle(1, thresholds)?;
            }
            self.beat(pixels, number == 0, thresholds)?;
        }
        Ok(())
    }

    /// Plays one beat as soon as the core takes it; `sof` marks the first beat of a frame.
    fn beat(
        &mut self,
        pixels: &[u16],
        sof: bool,
        thresholds: &Thresholds,
    ) -> Result<(), CosimError> {
        self.wait(thresholds)?;
        self.clock(&CoreInput { sof, ..CoreInput::valid(pixels, thresholds) })
    }

    /// Plays the time between two frames. Pixels that are offered while the core is busy are
    /// refused. With `is_long` everything is decided before the next frame.
    fn settle(&mut self, thresholds: &Thresholds, is_long: bool) -> Result<(), CosimError> {
        if self.waits && self.sink == SinkMood::Losing {
            self.sink = SinkMood::Willing;
        }
        let garbage = self.garbage.clone();
        for _ in 0..REFUSED {
            if !self.rig.is_ready() {
                self.clock(&CoreInput::valid(&garbage, thresholds))?;
            }
        }
        self.wait(thresholds)?;
        if is_long {
            self.idle(self.rig.settling_clocks(), thresholds)?;
        }
        Ok(())
    }

    /// Waits until all pixels have left.
    fn drain(&mut self, last: &Shot) -> Result<(), CosimError> {
        self.settle(&last.thresholds, true)?;
        let beats = self.rig.beats(&last.frame);
        for _ in 0..self.rig.frames_behind() {
            self.stream(&beats, &last.thresholds)?;
            self.settle(&last.thresholds, true)?;
        }
        self.idle(2, &last.thresholds)
    }

    /// Waits until a pixel can be taken.
    fn wait(&mut self, thresholds: &Thresholds) -> Result<(), CosimError> {
        while !self.rig.is_ready() {
            match self.rig.quiet_clocks() {
                0 | 1 => self.idle(1, thresholds)?,
                quiet => self.skip(quiet, thresholds)?,
            }
        }
        Ok(())
    }

    fn idle(&mut self, clocks: u64, thresholds: &Thresholds) -> Result<(), CosimError> {
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
            SinkMood::Willing => true,
            SinkMood::Losing => self.rig.takes_while_stalling(),
            SinkMood::Hesitant => self.takes_at_last(),
        };
        let applied = CoreInput { forward_ready, ..*applied };
        self.rig.clock(&applied, &mut self.tape.record);
        self.tape.push(1)
    }

    /// Returns true if a word has waited long enough.
    fn takes_at_last(&mut self) -> bool {
        self.waited = if self.rig.sends() { self.waited + 1 } else { 0 };
        let takes = self.waited > HESITATION;
        if takes {
            self.waited = 0;
        }
        takes
    }

    fn skip(&mut self, clocks: u64, thresholds: &Thresholds) -> Result<(), CosimError> {
        let applied = CoreInput::idle(&self.garbage, thresholds);
        self.rig.skip(&applied, &mut self.tape.record);
        self.tape.push(clocks)
    }
}
