// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state of a recording: it draws the frames of each sequence and offers them to the core.

use super::damaged_sequence::{
    DamagedSequence, DamagedSequenceEnd, DirectedSequence, FrameDelivery, directed_sequences,
};
use super::drain_timing::DrainTiming;
use super::driver::{FrameLimit, ModelDriver};
use super::faulty_store::StoreFault;
use super::frame_feed::FrameFeed;
use super::frame_generator::FrameGenerator;
use super::frame_parts::FramePart;
use super::random::Random;
use super::sequence_schedule::{SequenceLimits, SequenceSchedule};
use super::sequences::{FrameSequence, GapPattern, SequenceEnd, sequences};
use super::stimulus_pattern::VARYING_PATTERNS;
use super::threshold_aimer::ThresholdAim;
use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::recording::Recorder;
use foveate_design::{Design, PortRole};
use foveate_frame::Frame;
use std::sync::atomic::AtomicBool;

/// The state of a recording.
pub(super) struct StimulusSession<'a> {
    /// The design of the caller's frames.
    whole: &'a Design,
    /// The design that is simulated.
    design: &'a Design,
    level: CosimLevel,
    feed: FrameFeed<'a>,
    driver: ModelDriver<'a>,
    random: Random,
    frame_generator: FrameGenerator,
    drain_timing: DrainTiming,
    extent: SequenceLimits,
    is_left_out: fn(&str) -> bool,
}

impl<'a> StimulusSession<'a> {
    pub(super) fn new(
        (whole, design): (&'a Design, &'a Design),
        level: CosimLevel,
        (seed, extent, is_left_out): (u64, SequenceLimits, fn(&str) -> bool),
        recorder: &'a mut Recorder,
        cancel: &'a AtomicBool,
    ) -> Self {
        let mut random = Random::new(seed);
        let is_brief = extent.is_brief();
        let driver = ModelDriver::new(design, level, is_brief, recorder, random.fork(), cancel);
        let feed = FrameFeed::for_level(level, design);
        let gallery = FrameGenerator::new(&feed, &mut random);
        Self {
            whole,
            design,
            level,
            feed,
            driver,
            random,
            frame_generator: gallery,
            drain_timing: DrainTiming::for_design(design),
            extent,
            is_left_out,
        }
    }

    pub(super) fn run(
        &mut self,
        frames: &[Frame],
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), CosimError> {
        let parts = FramePart::all_of(self.whole, self.design, self.level, frames.len());
        let given = |session: &mut Self, number, part: FramePart| {
            session.play_caller_part(number, &part, frames)
        };
        let mut sequences = sequences(self.design);
        sequences.retain(|sequence| !(self.is_left_out)(sequence.name));
        let directed = &directed_sequences(&sequences, self.driver.has_frame_sync());
        let turns = SequenceSchedule { extent: self.extent, directed, caller_parts: parts };
        let play = |session: &mut Self,
                    sequence: &DirectedSequence<FrameSequence>,
                    round,
                    number| match sequence {
            DirectedSequence::Usual(sequence) => session.play_directed(sequence, round, number),
            DirectedSequence::Damaged(sequence) => session.play_damaged(sequence, round, number),
        };
        turns.record(self, play, given, progress)
    }

    /// Plays one directed sequence. Gaps and sinks differ from sequence to sequence and from round
    /// to round.
    fn play_directed(
        &mut self,
        sequence: &FrameSequence,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = match sequence.end {
            // With gaps the edge of the loss could be missed.
            SequenceEnd::BeforeLoss => GapPattern::None,
            _ => GapPattern::ALL[(round + number) % GapPattern::ALL.len()],
        };
        let border = self.driver.border(round + number);
        let sink = (sequence.sink_stalls, round + number / GapPattern::ALL.len());
        self.driver.name_clocks(sequence.name, 0, None);
        self.driver.begin_sequence(sequence.aim, sink, sequence.store_fault, border)?;
        let last = sequence.patterns.len() - 1;
        for frame in 0..=last {
            let configured = self.driver.thresholds_are_configured();
            let FrameSequence { patterns: motifs, is_mixed: mixed, .. } = *sequence;
            self.frame_generator.draw(motifs, frame + round, mixed, configured, &mut self.random);
            if frame > 0 {
                self.driver.name_clocks(sequence.name, frame as u64, None);
            }
            let drawn = self.frame_generator.frame()?;
            let until = match sequence.end {
                SequenceEnd::Loading(_) if frame == last => {
                    // At least one beat is taken, so that the reset comes within the frame.
                    FrameLimit::Beat(self.random.index(self.beats_per_frame() - 1).max(1))
                }
                SequenceEnd::BeforeLoss if frame == last => FrameLimit::BeforeLoss,
                _ => FrameLimit::WholeFrame,
            };
            self.send_frame(&drawn, until, gaps)?;
            if frame < last {
                self.pause_between_frames(&drawn, gaps)?;
            }
        }
        self.end_sequence(sequence.end, gaps)
    }

    /// Plays a sequence of damaged frames.
    fn play_damaged(
        &mut self,
        sequence: &DamagedSequence,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = GapPattern::ALL[(round + number) % GapPattern::ALL.len()];
        let sink = (number.is_multiple_of(2), round + number);
        self.driver.name_clocks(sequence.name, 0, None);
        self.driver.begin_sequence(ThresholdAim::Configured, sink, StoreFault::None, 0)?;
        for (frame, &delivery) in sequence.deliveries.iter().enumerate() {
            if frame > 0 {
                self.driver.name_clocks(sequence.name, frame as u64, None);
                if let Some(settle) = self.drain_timing.settling_clocks {
                    let pause = gaps.between_frames(settle, &mut self.random);
                    self.driver.idle(pause)?;
                }
            }
            self.frame_generator.draw(
                VARYING_PATTERNS,
                frame + round,
                true,
                true,
                &mut self.random,
            );
            self.send_damaged_frame(delivery, gaps)?;
        }
        match sequence.end {
            DamagedSequenceEnd::Drained => self.drain(&self.frame_generator.frame()?, gaps),
            DamagedSequenceEnd::AfterLastBeat => self.clocks_without_intake(1),
            DamagedSequenceEnd::Filling => {
                self.send_damaged_frame(FrameDelivery::FIRST_BEAT, gaps)?;
                let clocks = self.random.up_to(2);
                self.clocks_without_intake(clocks)
            }
        }
    }

    /// Plays a part of the caller's frames, back to back as far as the gaps allow.
    fn play_caller_part(
        &mut self,
        number: usize,
        part: &FramePart,
        frames: &[Frame],
    ) -> Result<(), CosimError> {
        let gaps = GapPattern::ALL[number % GapPattern::ALL.len()];
        self.driver.name_clocks(&part.name, 0, part.region);
        self.driver.begin_sequence(
            ThresholdAim::Configured,
            (false, number),
            StoreFault::None,
            part.border,
        )?;
        for (number, frame) in (0..).zip(frames) {
            if number > 0 {
                self.driver.name_clocks(&part.name, number, part.region);
                if let Some(settle) = self.drain_timing.settling_clocks {
                    let pause = gaps.between_frames(settle, &mut self.random);
                    self.driver.idle(pause)?;
                }
            }
            let seen = part.extract(self.whole, self.design, frame)?;
            self.send_frame(&seen, FrameLimit::WholeFrame, gaps)?;
            if number + 1 == frames.len() as u64 {
                self.drain(&seen, gaps)?;
            }
        }
        Ok(())
    }

    fn send_frame(
        &mut self,
        frame: &Frame,
        until: FrameLimit,
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        let beats = self.beats_of(frame);
        self.driver.send_frame(frame, &beats, until, gaps)
    }

    /// Offers the drawn frame, with the damage of `delivery`.
    fn send_damaged_frame(
        &mut self,
        delivery: FrameDelivery,
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        let frame = self.frame_generator.frame()?;
        let beats = self.beats_of(&frame);
        self.driver.send_damaged_frame(&beats, delivery, gaps)
    }

    /// Returns the beats of a frame for the pixel port; places without a pixel are random.
    fn beats_of(&mut self, frame: &Frame) -> Vec<Vec<u16>> {
        let max = u16::try_from(self.design.pixel_max()).expect("a pixel has at most 16 bits");
        let random = &mut self.random;
        self.feed.beats(frame, || random.pixel(max))
    }

    /// Returns the number of beats of a frame.
    fn beats_per_frame(&self) -> usize {
        let beats = self.design.timing().pixels_per_frame();
        usize::try_from(beats).expect("a frame is in memory")
    }

    /// Pauses between two frames, or not. A core that shows when everything has left is sometimes
    /// drained.
    fn pause_between_frames(&mut self, last: &Frame, gaps: GapPattern) -> Result<(), CosimError> {
        match self.drain_timing.settling_clocks {
            Some(settle) => {
                let pause = gaps.between_frames(settle, &mut self.random);
                self.driver.idle(pause)
            }
            None if gaps == GapPattern::Bursts && self.random.one_in(2) => self.drain(last, gaps),
            None => Ok(()),
        }
    }

    /// Brings the core to the state in which the next reset is to find it.
    fn end_sequence(&mut self, end: SequenceEnd, gaps: GapPattern) -> Result<(), CosimError> {
        let left = self.driver.model().clocks_until_ready();
        match end {
            SequenceEnd::Drained => self.drain(&self.frame_generator.frame()?, gaps),
            SequenceEnd::Loading(0) => {
                self.driver.cut_by_next_reset();
                Ok(())
            }
            SequenceEnd::Loading(most) => {
                let pause = self.random.up_to(most);
                self.driver.idle(pause)
            }
            SequenceEnd::Flushing(most) => {
                let clocks = self.random.up_to(most);
                self.clocks_without_intake(clocks)
            }
            SequenceEnd::LanesStarted => {
                let clocks = self.random.up_to(4);
                self.driver.work_until(left.saturating_sub(clocks))
            }
            // A score that is on its way to the ports must not come out.
            SequenceEnd::Working { first_score } if self.random.one_in(2) => {
                self.driver.work_until(first_score + 1)
            }
            SequenceEnd::Working { .. } => {
                let clocks = self.random.up_to(left);
                self.driver.work_until(clocks)
            }
            SequenceEnd::Rotating(most) => {
                let clocks = self.random.up_to(most);
                self.driver.work_until_score()?;
                let left = self.driver.model().clocks_until_ready();
                self.driver.work_until(left.saturating_sub(clocks))
            }
            SequenceEnd::Finishing(most) => {
                let clocks = self.random.up_to(most);
                self.driver.work_until(clocks)
            }
            SequenceEnd::BeforeLoss => Ok(()),
            SequenceEnd::Leaving(most) => {
                let is_leaving =
                    |driver: &ModelDriver<'_>| driver.model().is_high(PortRole::ForwardValid);
                // If pixels wait for further frames, the last frame is played again.
                for _ in 0..self.drain_timing.frames_behind {
                    if is_leaving(&self.driver) {
                        break;
                    }
                    self.driver.idle(self.drain_timing.settling_clocks.unwrap_or(0))?;
                    let beats = self.beats_of(&self.frame_generator.frame()?);
                    self.driver.push_until_leaving(&beats)?;
                }
                // Pixels in the windows are not pending, but the core is not ready while there are
                // some.
                let is_under_way = |driver: &ModelDriver<'_>| {
                    driver.model().is_pending() || !driver.model().is_ready()
                };
                while !is_leaving(&self.driver) && is_under_way(&self.driver) {
                    self.driver.clock_without_intake(None)?;
                }
                let clocks = self.random.up_to(most);
                self.clocks_without_intake(clocks)
            }
        }
    }

    fn clocks_without_intake(&mut self, clocks: u64) -> Result<(), CosimError> {
        for _ in 0..clocks {
            self.driver.clock_without_intake(None)?;
        }
        Ok(())
    }

    /// Lets all pixels leave, about every second time to a sink that is always ready. If the pixels
    /// of a frame wait for further frames, the last frame is played again.
    fn drain(&mut self, last: &Frame, gaps: GapPattern) -> Result<(), CosimError> {
        if self.driver.has_sink() && self.random.one_in(2) {
            self.driver.make_sink_ready();
        }
        for _ in 0..self.drain_timing.frames_behind {
            let pause = self.random.up_to(self.drain_timing.settling_clocks.unwrap_or(0));
            self.driver.idle(pause)?;
            let beats = self.beats_of(last);
            self.driver.push_out(&beats, gaps)?;
        }
        self.driver.drain()?;
        self.driver.idle(self.drain_timing.settling_clocks.unwrap_or(0))?;
        let pause = self.random.up_to(self.drain_timing.trailing_clocks);
        self.driver.idle(pause)
    }
}
