// SPDX-License-Identifier: MIT OR Apache-2.0
//! A recording under way: draws the frames of each sequence and offers them to the array.

use super::super::ahead::FrameAim;
use super::super::damage::{Damaged, Delivery, Directed, Stop, directed};
use super::super::gallery::Gallery;
use super::super::motif::TELLING;
use super::super::parts;
use super::super::random::Random;
use super::super::sequence::Gaps;
use super::super::turns::{Extent, Turns};
use super::driver::Driver;
use super::feed::Feed;
use super::sequence::{End, SEQUENCES, Sequence};
use crate::error::CosimError;
use crate::level::Level;
use foveate_design::{Phase, SerialDesign, SerialTiming};
use foveate_frame::Frame;

/// Clocks that are simulated after the last frame of a sequence has left.
const SILENCE: u64 = 5;

/// A recording under way.
pub(crate) struct Session<'a> {
    /// The design whose frames the caller gives.
    whole: SerialDesign<'a>,
    /// The design that is simulated.
    design: SerialDesign<'a>,
    level: Level,
    driver: Driver<'a>,
    random: Random,
    gallery: Gallery,
    clocks_per_frame: u64,
    /// Clocks in which the pixels of the last slot leave.
    unload: u64,
    /// Clocks until ready when the first score is at the ports.
    first_score: u64,
}

impl<'a> Session<'a> {
    pub(crate) fn new(
        whole: SerialDesign<'a>,
        design: SerialDesign<'a>,
        level: Level,
        timing: &SerialTiming,
        driver: Driver<'a>,
        mut random: Random,
    ) -> Self {
        let gallery = Gallery::new(&design, &mut random);
        let before = |&&(phase, _): &&(Phase, u64)| phase != Phase::RotateCount;
        let steps: u64 = timing.phases().iter().take_while(before).map(|&(_, steps)| steps).sum();
        Self {
            whole,
            design,
            level,
            driver,
            random,
            gallery,
            clocks_per_frame: timing.clocks_per_frame(),
            first_score: timing.edges_to_ready() - timing.edges_to_step(steps),
            unload: timing.phases().last().expect("a frame has phases").1,
        }
    }

    pub(crate) fn run(
        &mut self,
        extent: Extent,
        frames: &[Frame],
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), CosimError> {
        let given = |session: &mut Self, number, first| session.given(number, first, frames);
        let directed = &directed(SEQUENCES, self.design.syncs());
        let turns = Turns { extent, directed, given: self.parts(frames) };
        let play = |session: &mut Self, sequence: &Directed<Sequence>, round, number| match sequence
        {
            Directed::Usual(sequence) => session.directed(sequence, round, number),
            Directed::Damaged(sequence) => session.damaged(sequence, round, number),
        };
        turns.record(self, play, given, progress)
    }

    /// A damaged stream.
    fn damaged(
        &mut self,
        sequence: &Damaged,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = Gaps::ALL[(round + number) % Gaps::ALL.len()];
        self.driver.name(sequence.name, 0, None);
        self.driver.begin(FrameAim::Design)?;
        for (frame, &delivery) in sequence.deliveries.iter().enumerate() {
            if frame > 0 {
                self.driver.name(sequence.name, frame as u64, None);
            }
            self.draw_damaged(frame + round, delivery, gaps)?;
        }
        match sequence.stop {
            Stop::Drained => self.drain(),
            Stop::AtOnce => self.driver.idle(1),
            Stop::Filling => {
                self.draw_damaged(round, Delivery::FIRST, gaps)?;
                let clocks = self.random.up_to(2);
                self.driver.idle(clocks)
            }
        }
    }

    fn draw_damaged(
        &mut self,
        turn: usize,
        delivery: Delivery,
        gaps: Gaps,
    ) -> Result<(), CosimError> {
        self.gallery.draw(TELLING, turn, true, true, &mut self.random);
        let drawn = self.gallery.frame()?;
        let feed = self.feed(&drawn);
        self.driver.deliver(&feed, delivery, gaps)
    }

    /// One directed sequence. Gaps differ from sequence to sequence and from round to round.
    fn directed(
        &mut self,
        sequence: &Sequence,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = Gaps::ALL[(round + number) % Gaps::ALL.len()];
        self.driver.name(sequence.name, 0, None);
        self.driver.begin(sequence.aim)?;
        let last = sequence.motifs.len() - 1;
        for frame in 0..=last {
            let configured = self.driver.thresholds_are_configured();
            let Sequence { motifs, mixed, .. } = *sequence;
            self.gallery.draw(motifs, frame + round, mixed, configured, &mut self.random);
            if frame > 0 {
                self.driver.name(sequence.name, frame as u64, None);
            }
            let drawn = self.gallery.frame()?;
            let feed = self.feed(&drawn);
            let beats = match (sequence.end, frame == last) {
                (End::Loading, true) => self.below(feed.count()),
                _ => feed.count(),
            };
            self.driver.take(&feed, beats, gaps)?;
            if frame < last && gaps == Gaps::Bursts && self.random.one_in(2) {
                self.drain()?;
            }
        }
        self.end(sequence.end)
    }

    /// Brings the array to the place at which the next reset is to find it.
    fn end(&mut self, end: End) -> Result<(), CosimError> {
        let left = self.driver.clocks_until_ready();
        match end {
            End::Drained => self.drain(),
            End::Loading => {
                let pause = self.random.up_to(2);
                self.driver.idle(pause)
            }
            End::Start => {
                let clocks = self.random.up_to(4);
                self.driver.work_until(left.saturating_sub(clocks))
            }
            // What is on its way to the ports must not come out.
            End::Working if self.random.one_in(2) => self.driver.work_until(self.first_score + 1),
            End::Working => {
                let clocks = self.random.up_to(left);
                self.driver.work_until(clocks)
            }
            End::Rotating => {
                let clocks = self.random.up_to(u64::from(self.design.lanes()));
                self.driver.work_until_score()?;
                let left = self.driver.clocks_until_ready();
                self.driver.work_until(left.saturating_sub(clocks))
            }
            End::Unloading => {
                let clocks = self.random.up_to(self.unload);
                self.driver.work_until(clocks)
            }
            End::Ready => {
                let clocks = self.random.up_to(2);
                self.driver.work_until(clocks)
            }
        }
    }

    /// Lets everything leave.
    fn drain(&mut self) -> Result<(), CosimError> {
        self.driver.work_until(0)?;
        let pause = self.random.up_to(SILENCE);
        self.driver.idle(pause)
    }

    /// The parts of the caller's frames that are simulated, each by its first region; of an array one.
    fn parts(&self, frames: &[Frame]) -> Vec<u32> {
        match self.level {
            _ if frames.is_empty() => Vec::new(),
            Level::Rpu => {
                parts::first_regions(self.whole, frames.len() as u64 * self.clocks_per_frame)
            }
            Level::Rcm { .. } | Level::Full => vec![0],
        }
    }

    /// The caller's frames, through one lane or through the array.
    fn given(&mut self, number: usize, first: u32, frames: &[Frame]) -> Result<(), CosimError> {
        let gaps = Gaps::ALL[number % Gaps::ALL.len()];
        let region = (self.level == Level::Rpu).then_some(first);
        self.driver.name("frames", 0, region);
        self.driver.begin(FrameAim::Design)?;
        for (number, frame) in (0..).zip(frames) {
            if number > 0 {
                self.driver.name("frames", number, region);
            }
            let part = match self.level {
                Level::Rpu => parts::of_lane(self.whole, frame, first)?,
                Level::Rcm { .. } | Level::Full => parts::upper_left(&self.design, frame)?,
            };
            let feed = self.feed(&part);
            self.driver.take(&feed, feed.count(), gaps)?;
        }
        self.drain()
    }

    /// A frame as the pixel port takes it; what it shows for empty slots is random.
    fn feed(&mut self, frame: &Frame) -> Feed {
        let max = u16::try_from(self.design.pixel_max()).expect("a pixel has at most 16 bits");
        Feed::of(self.design, frame, || self.random.pixel(max))
    }

    fn below(&mut self, count: usize) -> usize {
        self.random.index(count.saturating_sub(1))
    }
}
