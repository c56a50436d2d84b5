// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state of a recording: it draws the frames of each sequence and offers them to the core.

use super::clock_receiver::ClockReceiver;
use super::damaged_sequence::{
    DamagedSequence, DamagedSequenceEnd, DirectedSequence, FrameDelivery, directed_sequences,
};
use super::frame_feed::FrameFeed;
use super::frame_generator::FrameGenerator;
use super::frame_parts::FramePart;
use super::gap_pattern::GapPattern;
use super::model_driver::{FrameLimit, ModelDriver, SequenceSurroundings};
use super::random::Random;
use super::sequence_end::SequenceEnd;
use super::sequence_schedule::{SequenceLimits, SequenceSchedule};
use super::sequences::{FrameSequence, sequences};
use super::sink::SinkPattern;
use super::stimulus_pattern::VARYING_PATTERNS;
use super::unused_inputs::UnusedInputs;
use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::recording::Recorder;
use foveate_design::{Design, PortRole};
use foveate_frame::Frame;
use std::sync::atomic::AtomicBool;

/// The number that is added to the turns of the sinks of a recording with few sequences: its first
/// sink that stalls is then the one that loses most regions.
const LOSSY_TURN_OFFSET: usize = 3;

/// The state of a recording.
pub(super) struct StimulusSession<'a> {
    /// The design of the caller's frames.
    whole: &'a Design,
    /// The design that is simulated.
    design: &'a Design,
    level: CosimLevel,
    driver: ModelDriver<'a, Recorder>,
    has_border: bool,
    random: Random,
    frame_generator: FrameGenerator,
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
        let feed = FrameFeed::for_level(level, design);
        let has_border = recorder.has_port(PortRole::Border);
        let top = (design, level.top());
        let unused = UnusedInputs::Random;
        let driver = ModelDriver::new(top, feed, unused, recorder, random.fork(), cancel);
        let frame_generator = FrameGenerator::new(&feed, &mut random);
        Self {
            whole,
            design,
            level,
            driver,
            has_border,
            random,
            frame_generator,
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
            _ => gaps_of_turn(round + number),
        };
        let turn = round + number / GapPattern::IN_TURN.len();
        self.name_clocks(sequence.name, 0, None);
        self.driver.begin_sequence(SequenceSurroundings {
            aim: sequence.aim,
            sink: (sequence.sink_stalls, self.sink_turn(turn)),
            store_fault: sequence.store_fault,
            border: self.border(round + number),
        })?;
        let last = sequence.patterns.len() - 1;
        for frame in 0..=last {
            let configured = self.driver.thresholds_are_configured();
            let FrameSequence { patterns, is_mixed, .. } = *sequence;
            let turn = frame + round;
            self.frame_generator.draw(patterns, turn, is_mixed, configured, &mut self.random);
            if frame > 0 {
                self.name_clocks(sequence.name, frame as u64, None);
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
            self.driver.send_frame(&drawn, until, gaps)?;
            if frame < last {
                self.pause_between_frames(&drawn, gaps)?;
            }
        }
        let last = self.frame_generator.frame()?;
        match sequence.end {
            SequenceEnd::Drained => self.drain(&last, gaps),
            end => self.driver.end_sequence(end, &last, gaps),
        }
    }

    /// Plays a sequence of damaged frames.
    fn play_damaged(
        &mut self,
        sequence: &DamagedSequence,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = gaps_of_turn(round + number);
        let sink = (number.is_multiple_of(2), self.sink_turn(round + number));
        self.name_clocks(sequence.name, 0, None);
        self.driver.begin_sequence(SequenceSurroundings::of_design(sink, 0))?;
        for (frame, &delivery) in sequence.deliveries.iter().enumerate() {
            if frame > 0 {
                self.name_clocks(sequence.name, frame as u64, None);
                self.pause_blindly(gaps)?;
            }
            let turn = frame + round;
            self.frame_generator.draw(VARYING_PATTERNS, turn, true, true, &mut self.random);
            self.driver.send_damaged_frame(&self.frame_generator.frame()?, delivery, gaps)?;
        }
        let last = self.frame_generator.frame()?;
        match sequence.end {
            DamagedSequenceEnd::Drained => self.drain(&last, gaps),
            DamagedSequenceEnd::AfterLastBeat => self.driver.clocks_without_intake(1),
            DamagedSequenceEnd::Filling => {
                self.driver.send_damaged_frame(&last, FrameDelivery::FIRST_BEAT, gaps)?;
                let clocks = self.random.up_to(2);
                self.driver.clocks_without_intake(clocks)
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
        let gaps = gaps_of_turn(number);
        let sink = (false, self.sink_turn(number));
        self.name_clocks(&part.name, 0, part.region);
        self.driver.begin_sequence(SequenceSurroundings::of_design(sink, part.border))?;
        for (number, frame) in (0..).zip(frames) {
            if number > 0 {
                self.name_clocks(&part.name, number, part.region);
                self.pause_blindly(gaps)?;
            }
            let seen = part.extract(self.whole, self.design, frame)?;
            self.driver.send_frame(&seen, FrameLimit::WholeFrame, gaps)?;
            if number + 1 == frames.len() as u64 {
                self.drain(&seen, gaps)?;
            }
        }
        Ok(())
    }

    /// Names the sequence, frame and region of the following clocks.
    fn name_clocks(&mut self, sequence: &str, frame: u64, region: Option<u32>) {
        self.driver.receiver().begin_frame(sequence, frame, region);
    }

    /// Returns the sides at the frame's border for a sequence, if these are an input; all sixteen
    /// sets come in turn.
    fn border(&self, turn: usize) -> u8 {
        match self.has_border {
            true => u8::try_from(7 * turn % 16).expect("four bits"),
            false => 0,
        }
    }

    /// Returns the turn of a sink for the turn of a sequence.
    fn sink_turn(&self, turn: usize) -> usize {
        turn + if self.extent.is_brief() { LOSSY_TURN_OFFSET } else { 0 }
    }

    /// Returns the number of beats of a frame.
    fn beats_per_frame(&self) -> usize {
        let beats = self.design.timing().pixels_per_frame();
        usize::try_from(beats).expect("a frame is in memory")
    }

    /// Pauses between two frames, or not. A core that shows when everything has left is sometimes
    /// drained.
    fn pause_between_frames(&mut self, last: &Frame, gaps: GapPattern) -> Result<(), CosimError> {
        let shows_end = self.driver.drain_timing().clocks_to_wait().is_none();
        if shows_end && gaps == GapPattern::Bursts && self.random.one_in(2) {
            return self.drain(last, gaps);
        }
        self.pause_blindly(gaps)
    }

    /// Lets all pixels leave, about every second time to a sink that is always ready.
    fn drain(&mut self, last: &Frame, gaps: GapPattern) -> Result<(), CosimError> {
        if self.driver.has_sink() && self.random.one_in(2) {
            self.driver.set_sink(SinkPattern::Always);
        }
        self.driver.drain(last, gaps)
    }

    /// Pauses between two frames of a core that does not show when everything has left.
    fn pause_blindly(&mut self, gaps: GapPattern) -> Result<(), CosimError> {
        let Some(settling) = self.driver.drain_timing().clocks_to_wait() else { return Ok(()) };
        let pause = gaps.between_frames(settling, &mut self.random);
        self.driver.idle(pause)
    }
}

/// Returns the gaps of a sequence.
fn gaps_of_turn(turn: usize) -> GapPattern {
    GapPattern::IN_TURN[turn % GapPattern::IN_TURN.len()]
}
