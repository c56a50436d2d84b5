// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state of a recording: it draws the frames of each sequence and offers them to the core.

use super::ahead::ThresholdAim;
use super::damage::{Damaged, Delivery, Directed, Stop, directed};
use super::driver::{Driver, Until};
use super::feed::FrameFeed;
use super::gallery::Gallery;
use super::memory::Lapse;
use super::motif::TELLING;
use super::pace::Pace;
use super::parts::Part;
use super::random::Random;
use super::sequences::{End, Gaps, Sequence, sequences};
use super::turns::{Extent, Turns};
use crate::error::CosimError;
use crate::level::Level;
use crate::recording::Recorder;
use foveate_design::{Design, PortRole};
use foveate_frame::Frame;
use std::sync::atomic::AtomicBool;

/// The state of a recording.
pub(super) struct Session<'a> {
    /// The design of the caller's frames.
    whole: &'a Design,
    /// The design that is simulated.
    design: &'a Design,
    level: Level,
    feed: FrameFeed<'a>,
    driver: Driver<'a>,
    random: Random,
    gallery: Gallery,
    pace: Pace,
    extent: Extent,
    is_left_out: fn(&str) -> bool,
}

impl<'a> Session<'a> {
    pub(super) fn new(
        (whole, design): (&'a Design, &'a Design),
        level: Level,
        (seed, extent, is_left_out): (u64, Extent, fn(&str) -> bool),
        recorder: &'a mut Recorder,
        cancel: &'a AtomicBool,
    ) -> Self {
        let mut random = Random::new(seed);
        let is_brief = extent.is_brief();
        let driver = Driver::new(design, level, is_brief, recorder, random.fork(), cancel);
        let feed = FrameFeed::at(level, design);
        let gallery = Gallery::new(&feed, &mut random);
        Self {
            whole,
            design,
            level,
            feed,
            driver,
            random,
            gallery,
            pace: Pace::of(design),
            extent,
            is_left_out,
        }
    }

    pub(super) fn run(
        &mut self,
        frames: &[Frame],
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), CosimError> {
        let parts = Part::all_of(self.whole, self.design, self.level, frames.len());
        let given = |session: &mut Self, number, part: Part| session.given(number, &part, frames);
        let mut sequences = sequences(self.design);
        sequences.retain(|sequence| !(self.is_left_out)(sequence.name));
        let directed = &directed(&sequences, self.driver.finds_frames());
        let turns = Turns { extent: self.extent, directed, given: parts };
        let play = |session: &mut Self, sequence: &Directed<Sequence>, round, number| match sequence
        {
            Directed::Usual(sequence) => session.directed(sequence, round, number),
            Directed::Damaged(sequence) => session.damaged(sequence, round, number),
        };
        turns.record(self, play, given, progress)
    }

    /// Plays one directed sequence. Gaps and sinks differ from sequence to sequence and from round
    /// to round.
    fn directed(
        &mut self,
        sequence: &Sequence,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = match sequence.end {
            // With gaps the edge of the loss could be missed.
            End::Losing => Gaps::None,
            _ => Gaps::ALL[(round + number) % Gaps::ALL.len()],
        };
        let border = self.driver.border(round + number);
        let sink = (sequence.stalls, round + number / Gaps::ALL.len());
        self.driver.name(sequence.name, 0, None);
        self.driver.begin(sequence.aim, sink, sequence.lapse, border)?;
        let last = sequence.motifs.len() - 1;
        for frame in 0..=last {
            let configured = self.driver.thresholds_are_configured();
            let Sequence { motifs, mixed, .. } = *sequence;
            self.gallery.draw(motifs, frame + round, mixed, configured, &mut self.random);
            if frame > 0 {
                self.driver.name(sequence.name, frame as u64, None);
            }
            let drawn = self.gallery.frame()?;
            let until = match sequence.end {
                End::Loading(_) if frame == last => {
                    // At least one beat is taken, so that the reset comes within the frame.
                    Until::Beat(self.random.index(self.beats() - 1).max(1))
                }
                End::Losing if frame == last => Until::Loss,
                _ => Until::End,
            };
            self.take(&drawn, until, gaps)?;
            if frame < last {
                self.between_frames(&drawn, gaps)?;
            }
        }
        self.end(sequence.end, gaps)
    }

    /// Plays a sequence of damaged frames.
    fn damaged(
        &mut self,
        sequence: &Damaged,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = Gaps::ALL[(round + number) % Gaps::ALL.len()];
        let sink = (number.is_multiple_of(2), round + number);
        self.driver.name(sequence.name, 0, None);
        self.driver.begin(ThresholdAim::Design, sink, Lapse::None, 0)?;
        for (frame, &delivery) in sequence.deliveries.iter().enumerate() {
            if frame > 0 {
                self.driver.name(sequence.name, frame as u64, None);
                if let Some(settle) = self.pace.settle {
                    let pause = gaps.between_frames(settle, &mut self.random);
                    self.driver.idle(pause)?;
                }
            }
            self.gallery.draw(TELLING, frame + round, true, true, &mut self.random);
            self.deliver(delivery, gaps)?;
        }
        match sequence.stop {
            Stop::Drained => self.drain(&self.gallery.frame()?, gaps),
            Stop::AtOnce => self.busy(1),
            Stop::Filling => {
                self.deliver(Delivery::FIRST, gaps)?;
                let clocks = self.random.up_to(2);
                self.busy(clocks)
            }
        }
    }

    /// Plays a part of the caller's frames, back to back as far as the gaps allow.
    fn given(&mut self, number: usize, part: &Part, frames: &[Frame]) -> Result<(), CosimError> {
        let gaps = Gaps::ALL[number % Gaps::ALL.len()];
        self.driver.name(&part.name, 0, part.region);
        self.driver.begin(ThresholdAim::Design, (false, number), Lapse::None, part.border)?;
        for (number, frame) in (0..).zip(frames) {
            if number > 0 {
                self.driver.name(&part.name, number, part.region);
                if let Some(settle) = self.pace.settle {
                    let pause = gaps.between_frames(settle, &mut self.random);
                    self.driver.idle(pause)?;
                }
            }
            let seen = part.cut(self.whole, self.design, frame)?;
            self.take(&seen, Until::End, gaps)?;
            if number + 1 == frames.len() as u64 {
                self.drain(&seen, gaps)?;
            }
        }
        Ok(())
    }

    fn take(&mut self, frame: &Frame, until: Until, gaps: Gaps) -> Result<(), CosimError> {
        let beats = self.feed(frame);
        self.driver.take(frame, &beats, until, gaps)
    }

    /// Offers the drawn frame, with the damage of `delivery`.
    fn deliver(&mut self, delivery: Delivery, gaps: Gaps) -> Result<(), CosimError> {
        let frame = self.gallery.frame()?;
        let beats = self.feed(&frame);
        self.driver.deliver(&beats, delivery, gaps)
    }

    /// Returns the beats of a frame for the pixel port; places without a pixel are random.
    fn feed(&mut self, frame: &Frame) -> Vec<Vec<u16>> {
        let max = u16::try_from(self.design.pixel_max()).expect("a pixel has at most 16 bits");
        let random = &mut self.random;
        self.feed.beats(frame, || random.pixel(max))
    }

    /// Returns the number of beats of a frame.
    fn beats(&self) -> usize {
        let beats = self.design.timing().pixels_per_frame();
        usize::try_from(beats).expect("a frame is in memory")
    }

    /// Pauses between two frames, or not. A core that shows when everything has left is sometimes
    /// drained.
    fn between_frames(&mut self, last: &Frame, gaps: Gaps) -> Result<(), CosimError> {
        match self.pace.settle {
            Some(settle) => {
                let pause = gaps.between_frames(settle, &mut self.random);
                self.driver.idle(pause)
            }
            None if gaps == Gaps::Bursts && self.random.one_in(2) => self.drain(last, gaps),
            None => Ok(()),
        }
    }

    /// Brings the core to the state in which the next reset is to find it.
    fn end(&mut self, end: End, gaps: Gaps) -> Result<(), CosimError> {
        let left = self.driver.core().clocks_until_ready();
        match end {
            End::Drained => self.drain(&self.gallery.frame()?, gaps),
            End::Loading(0) => {
                self.driver.cut();
                Ok(())
            }
            End::Loading(most) => {
                let pause = self.random.up_to(most);
                self.driver.idle(pause)
            }
            End::Flushing(most) => {
                let clocks = self.random.up_to(most);
                self.busy(clocks)
            }
            End::Begun => {
                let clocks = self.random.up_to(4);
                self.driver.work_until(left.saturating_sub(clocks))
            }
            // A score that is on its way to the ports must not come out.
            End::Working { first_score } if self.random.one_in(2) => {
                self.driver.work_until(first_score + 1)
            }
            End::Working { .. } => {
                let clocks = self.random.up_to(left);
                self.driver.work_until(clocks)
            }
            End::Rotating(most) => {
                let clocks = self.random.up_to(most);
                self.driver.work_until_score()?;
                let left = self.driver.core().clocks_until_ready();
                self.driver.work_until(left.saturating_sub(clocks))
            }
            End::Finishing(most) => {
                let clocks = self.random.up_to(most);
                self.driver.work_until(clocks)
            }
            End::Losing => Ok(()),
            End::Leaving(most) => {
                let is_leaving =
                    |driver: &Driver<'_>| driver.core().is_high(PortRole::ForwardValid);
                // If pixels wait for further frames, the last frame is played again.
                for _ in 0..self.pace.frames_behind {
                    if is_leaving(&self.driver) {
                        break;
                    }
                    self.driver.idle(self.pace.settle.unwrap_or(0))?;
                    let beats = self.feed(&self.gallery.frame()?);
                    self.driver.push_until_leaving(&beats)?;
                }
                // Pixels in the windows are not pending, but the core is not ready while there are
                // some.
                let is_under_way =
                    |driver: &Driver<'_>| driver.core().is_pending() || !driver.core().is_ready();
                while !is_leaving(&self.driver) && is_under_way(&self.driver) {
                    self.driver.busy(None)?;
                }
                let clocks = self.random.up_to(most);
                self.busy(clocks)
            }
        }
    }

    fn busy(&mut self, clocks: u64) -> Result<(), CosimError> {
        for _ in 0..clocks {
            self.driver.busy(None)?;
        }
        Ok(())
    }

    /// Lets all pixels leave, about every second time to a sink that is always ready. If the pixels
    /// of a frame wait for further frames, the last frame is played again.
    fn drain(&mut self, last: &Frame, gaps: Gaps) -> Result<(), CosimError> {
        if self.driver.has_sink() && self.random.one_in(2) {
            self.driver.calm_sink();
        }
        for _ in 0..self.pace.frames_behind {
            let pause = self.random.up_to(self.pace.settle.unwrap_or(0));
            self.driver.idle(pause)?;
            let beats = self.feed(last);
            self.driver.push_out(&beats, gaps)?;
        }
        self.driver.drain()?;
        self.driver.idle(self.pace.settle.unwrap_or(0))?;
        let pause = self.random.up_to(self.pace.silence);
        self.driver.idle(pause)
    }
}
