// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state of a recording: it draws the frames of each sequence and offers them to the core.

use super::frame_feed::{FrameFeed, FramePart, GapPattern};
use super::frame_generator::FrameGenerator;
use super::model_driver::{ClockReceiver, FrameLimit, ModelDriver, SequenceSurroundings};
use super::random::Random;
use super::sequence_end::SequenceEnd;
use super::sequences::{FrameSequence, sequences};
use super::sink::SinkPattern;
use super::unused_inputs::UnusedInputs;
use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::recording::Recorder;
use foveate_design::{Design, PortRole};
use foveate_model::FunctionalCamera;
use foveate_pixels::Frame;
use std::sync::atomic::AtomicBool;

/// The settings of a recording.
#[derive(Clone, Copy)]
pub(super) struct StimulusPlan {
    pub(super) seed: u64,
    pub(super) limits: SequenceLimits,
    /// Returns true for the names of directed sequences that are not recorded.
    pub(super) is_left_out: fn(&str) -> bool,
    pub(super) pace: StimulusPace,
}

/// The pace of the caller's frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StimulusPace {
    /// With and without pauses, during which unused inputs have random values.
    Varied,
    /// Without pauses, and with fixed values at unused inputs.
    Steady {
        /// The largest number of parts of the frames; they are spread evenly.
        max_parts: u64,
    },
}

/// The number of directed sequences that are recorded.
#[derive(Clone, Copy, Debug)]
pub(super) struct SequenceLimits {
    pub(super) rounds: u32,
    /// The largest number of directed sequences per round, from the first on.
    pub(super) max_sequences: usize,
}

impl SequenceLimits {
    /// Returns true if some sequences may be left out.
    fn is_brief(self) -> bool {
        self.max_sequences != usize::MAX
    }
}

/// The number that is added to the turns of the sinks of a recording with few sequences: its first
/// sink that stalls is then the one that loses most regions.
const LOSSY_TURN_OFFSET: usize = 3;

/// The number of frames of noise that are drawn to find one with a relevant region.
const MAX_NOISE_FRAMES: usize = 64;

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
    plan: StimulusPlan,
}

impl<'a> StimulusSession<'a> {
    pub(super) fn new(
        (whole, design): (&'a Design, &'a Design),
        level: CosimLevel,
        plan: StimulusPlan,
        recorder: &'a mut Recorder,
        cancel: &'a AtomicBool,
    ) -> Self {
        let mut random = Random::new(plan.seed);
        let feed = FrameFeed::for_level(level, design);
        let has_border = recorder.has_port(PortRole::Border);
        let top = (design, level.top());
        let unused = match plan.pace {
            StimulusPace::Varied => UnusedInputs::Random,
            StimulusPace::Steady { .. } => UnusedInputs::Constant { refused_clocks: 0 },
        };
        let driver = ModelDriver::new(top, feed, unused, recorder, random.fork(), cancel);
        let frame_generator = FrameGenerator::new(&feed, &mut random);
        Self { whole, design, level, driver, has_border, random, frame_generator, plan }
    }

    /// Records all sequences: the directed ones in every round, then the parts of the caller's
    /// frames. `progress` gets the number of finished sequences and the number of all.
    pub(super) fn run(
        &mut self,
        frames: &[Frame],
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), CosimError> {
        let most = match self.plan.pace {
            StimulusPace::Varied => None,
            StimulusPace::Steady { max_parts } => Some(max_parts),
        };
        let count = frames.len();
        let parts = FramePart::all_of(self.whole, self.design, self.level, count, most);
        let mut directed = sequences(self.design, self.driver.has_frame_sync());
        directed.retain(|sequence| !(self.plan.is_left_out)(sequence.name));
        directed.truncate(self.plan.limits.max_sequences);
        let total = u64::from(self.plan.limits.rounds) * directed.len() as u64 + parts.len() as u64;
        let mut finished = 0..=total;
        let mut advance = || progress(finished.next().unwrap_or(total), total);
        advance();
        for round in 0..self.plan.limits.rounds as usize {
            for (number, sequence) in directed.iter().enumerate() {
                self.play_directed(sequence, round, number)?;
                advance();
            }
        }
        for (number, part) in parts.iter().enumerate() {
            self.play_caller_part(number, part, frames)?;
            advance();
        }
        Ok(())
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
        let sink_turn = self.sink_turn(round + number / GapPattern::IN_TURN.len());
        self.name_clocks(sequence.name, 0, None);
        self.driver.begin_sequence(SequenceSurroundings {
            aim: sequence.aim,
            sink: (sequence.sink_stalls, sink_turn),
            store_fault: sequence.store_fault,
            border: self.border(round + number),
            classes: sequence.classes,
        })?;
        for frame in 0..sequence.frame_count() {
            if frame > 0 {
                let last = self.frame_generator.frame()?;
                let drained = Some(&last).filter(|_| sequence.deliveries.is_empty());
                self.pause_between_frames(drained, gaps)?;
                self.name_clocks(sequence.name, frame as u64, None);
            }
            let drawn = self.draw_frame(sequence, frame + round)?;
            match sequence.deliveries.get(frame) {
                Some(&delivery) => self.driver.send_damaged_frame(&drawn, delivery, gaps)?,
                None => {
                    let limit = self.frame_limit(sequence, frame);
                    self.driver.send_frame(&drawn, limit, gaps)?;
                }
            }
        }
        let last = self.frame_generator.frame()?;
        match sequence.end {
            SequenceEnd::Drained => self.drain(&last, gaps),
            end => self.driver.end_sequence(end, &last, gaps),
        }
    }

    /// Draws the next frame of a directed sequence. Noise that must be relevant is drawn again
    /// while no region of the frame is.
    fn draw_frame(&mut self, sequence: &FrameSequence, turn: usize) -> Result<Frame, CosimError> {
        let (FrameSequence { patterns, is_mixed, .. }, aim) =
            (*sequence, self.driver.pattern_aim());
        for _ in 0..MAX_NOISE_FRAMES {
            let random = &mut self.random;
            let is_noise = self.frame_generator.draw(patterns, turn, is_mixed, aim, random);
            if !is_noise || self.has_relevant_region(&self.frame_generator.frame()?) {
                break;
            }
        }
        self.frame_generator.frame()
    }

    /// Returns true if a region of a first frame is relevant with the thresholds of the design, or
    /// if the frame is a square, whose halo is drawn with it.
    fn has_relevant_region(&self, frame: &Frame) -> bool {
        let is_square =
            (frame.width(), frame.height()) != (self.design.width(), self.design.height());
        let mut camera = FunctionalCamera::new(self.design);
        is_square || camera.step(frame).is_ok_and(|outcome| outcome.srs.contains(&true))
    }

    /// Returns the part of a frame that is taken: all of it, unless the next reset must find the
    /// core within the last frame.
    fn frame_limit(&mut self, sequence: &FrameSequence, frame: usize) -> FrameLimit {
        let is_last = frame + 1 == sequence.frame_count();
        match sequence.end {
            SequenceEnd::Loading(_) if is_last => {
                // At least one beat is taken, so that the reset comes within the frame.
                FrameLimit::Beat(self.random.index(self.beats_per_frame() - 1).max(1))
            }
            SequenceEnd::BeforeLoss if is_last => FrameLimit::BeforeLoss,
            _ => FrameLimit::WholeFrame,
        }
    }

    /// Plays a part of the caller's frames, back to back as far as the gaps allow.
    fn play_caller_part(
        &mut self,
        number: usize,
        part: &FramePart,
        frames: &[Frame],
    ) -> Result<(), CosimError> {
        let gaps = match self.plan.pace {
            StimulusPace::Varied => gaps_of_turn(number),
            StimulusPace::Steady { .. } => GapPattern::None,
        };
        let sink = (false, self.sink_turn(number));
        self.name_clocks(&part.name, 0, part.region);
        self.driver.begin_sequence(SequenceSurroundings::of_design(sink, part.border))?;
        for (number, frame) in (0..).zip(frames) {
            if number > 0 {
                self.pause_between_frames(None, gaps)?;
                self.name_clocks(&part.name, number, part.region);
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

    fn sink_turn(&self, turn: usize) -> usize {
        turn + if self.plan.limits.is_brief() { LOSSY_TURN_OFFSET } else { 0 }
    }

    fn beats_per_frame(&self) -> usize {
        let beats = self.design.timing().pixels_per_frame();
        usize::try_from(beats).expect("a frame is in memory")
    }

    /// Pauses between two frames, or not. A core that shows when everything has left is sometimes
    /// drained if the last frame, `drained`, is given.
    fn pause_between_frames(
        &mut self,
        drained: Option<&Frame>,
        gaps: GapPattern,
    ) -> Result<(), CosimError> {
        match (self.driver.drain_timing().clocks_to_wait(), drained) {
            (Some(settling), _) => {
                let pause = gaps.between_frames(settling, &mut self.random);
                self.driver.idle(pause)
            }
            (None, Some(last)) if gaps == GapPattern::Bursts && self.random.one_in(2) => {
                self.drain(last, gaps)
            }
            (None, _) => Ok(()),
        }
    }

    /// Lets all pixels leave, about every second time to a sink that is always ready.
    fn drain(&mut self, last: &Frame, gaps: GapPattern) -> Result<(), CosimError> {
        if self.driver.has_sink() && self.random.one_in(2) {
            self.driver.set_sink(SinkPattern::Always);
        }
        self.driver.drain(last, gaps)
    }
}

/// Returns the gaps of a sequence.
fn gaps_of_turn(turn: usize) -> GapPattern {
    GapPattern::IN_TURN[turn % GapPattern::IN_TURN.len()]
}
