// SPDX-License-Identifier: MIT OR Apache-2.0
//! A recording under way: draws the frames of each sequence and offers them to the core.

use super::super::ahead::FrameAim;
use super::super::damage::{Damaged, Delivery, Directed, Stop, directed};
use super::super::gallery::Gallery;
use super::super::motif::TELLING;
use super::super::parts::{self, MAX_CLOCKS};
use super::super::random::Random;
use super::super::sequence::Gaps;
use super::super::turns::{Extent, Turns};
use super::driver::{Driver, Until};
use super::memory::Lapse;
use super::sequence::{End, Sequence, sequences};
use super::sink::Mood;
use crate::error::CosimError;
use crate::level::Level;
use foveate_design::{Design, RasterDesign, RasterTiming};
use foveate_frame::Frame;

/// The sink that loses most of those that stall: the one of a recording that has few sequences.
const MOST_LOSSES: usize = 3;
/// Clocks that are simulated after the last pixel of a sequence has left.
const SILENCE: u64 = 8;

/// A recording under way.
pub(crate) struct Session<'a> {
    /// The design whose frames the caller gives.
    whole: &'a Design,
    /// The design that is simulated.
    design: RasterDesign<'a>,
    level: Level,
    driver: Driver<'a>,
    random: Random,
    gallery: Gallery,
    timing: RasterTiming,
    /// Which sink comes first.
    first_mood: usize,
}

impl<'a> Session<'a> {
    pub(crate) fn new(
        whole: &'a Design,
        design: RasterDesign<'a>,
        level: Level,
        driver: Driver<'a>,
        mut random: Random,
    ) -> Self {
        let gallery = Gallery::new(&design, &mut random);
        Self {
            whole,
            design,
            level,
            driver,
            random,
            gallery,
            timing: RasterTiming::of(design),
            first_mood: 0,
        }
    }

    pub(crate) fn run(
        &mut self,
        extent: Extent,
        frames: &[Frame],
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), CosimError> {
        let directed = &directed(&sequences(self.design), self.design.syncs());
        if extent.is_brief() {
            self.first_mood = MOST_LOSSES;
        }
        let given = |session: &mut Self, number, corner| session.given(number, corner, frames);
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
        let mood = self.mood(number.is_multiple_of(2), round + number);
        self.driver.name(sequence.name, 0);
        self.driver.begin(FrameAim::Design, mood, Lapse::None)?;
        for (frame, &delivery) in sequence.deliveries.iter().enumerate() {
            if frame > 0 {
                self.driver.name(sequence.name, frame as u64);
            }
            self.gallery.draw(TELLING, frame + round, true, true, &mut self.random);
            self.driver.deliver(&self.gallery.frame()?, delivery, gaps)?;
        }
        match sequence.stop {
            Stop::Drained => self.drain(),
            Stop::AtOnce => self.busy(1),
            Stop::Filling => {
                self.driver.deliver(&self.gallery.frame()?, Delivery::FIRST, gaps)?;
                let clocks = self.random.up_to(2);
                self.busy(clocks)
            }
        }
    }

    /// One directed sequence. Gaps and sinks differ from sequence to sequence and from round to round.
    fn directed(
        &mut self,
        sequence: &Sequence,
        round: usize,
        number: usize,
    ) -> Result<(), CosimError> {
        let gaps = match sequence.end {
            // The edge of the loss is not to be missed.
            End::Losing => Gaps::None,
            _ => Gaps::ALL[(round + number) % Gaps::ALL.len()],
        };
        let mood = self.mood(sequence.stalls, round + number / Gaps::ALL.len());
        self.driver.name(sequence.name, 0);
        self.driver.begin(sequence.aim, mood, sequence.lapse)?;
        let last = sequence.motifs.len() - 1;
        for frame in 0..=last {
            let configured = self.driver.thresholds_are_configured();
            let Sequence { motifs, mixed, .. } = *sequence;
            self.gallery.draw(motifs, frame + round, mixed, configured, &mut self.random);
            if frame > 0 {
                self.driver.name(sequence.name, frame as u64);
            }
            let drawn = self.gallery.frame()?;
            let taken = usize::try_from(self.timing.taken()).expect("a frame is in memory");
            let until = match sequence.end {
                End::Loading if frame == last => Until::Word(self.random.index(taken - 1)),
                End::Losing if frame == last => Until::Loss,
                _ => Until::End,
            };
            self.driver.take(&drawn, until, gaps)?;
            if frame < last && gaps == Gaps::Bursts && self.random.one_in(2) {
                self.drain()?;
            }
        }
        self.end(sequence.end)
    }

    /// A sink; one that stalls does so for up to two rows of regions more than the buffer holds.
    fn mood(&mut self, stalls: bool, turn: usize) -> Mood {
        let row = self.timing.words() / u64::from(self.design.rows());
        let rows = u64::from(self.timing.buffer_rows) + 2;
        match (stalls, (turn + self.first_mood) % 4) {
            (true, 0) => Mood::Slow,
            (true, 1 | 2) => Mood::Unlucky(rows * row),
            (true, _) => Mood::Turns(rows * row),
            (false, 0) => Mood::Willing,
            (false, 1) => Mood::Hesitant,
            (false, 2) => Mood::Turns(row / 2),
            (false, _) => Mood::Turns(9),
        }
    }

    /// Brings the core to the place at which the next reset is to find it.
    fn end(&mut self, end: End) -> Result<(), CosimError> {
        match end {
            End::Drained => self.drain(),
            End::Loading => {
                let pause = self.random.up_to(2);
                self.driver.idle(pause)
            }
            End::Flushing => {
                let clocks = self.random.up_to(self.timing.edges_to_ready());
                self.busy(clocks)
            }
            End::Losing => Ok(()),
            End::Leaving => {
                while !self.driver.output().forward_valid && self.driver.is_pending() {
                    self.driver.busy(None)?;
                }
                let clocks = self.random.up_to(2 * u64::from(self.timing.region_words));
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

    /// Lets everything leave, every other time to a sink that is always ready.
    fn drain(&mut self) -> Result<(), CosimError> {
        if self.random.one_in(2) {
            self.driver.calm_sink();
        }
        self.driver.drain()?;
        let pause = self.random.up_to(SILENCE);
        self.driver.idle(pause)
    }

    /// The upper left corners of the parts of the caller's frames that are simulated: of the core one, of the
    /// lone core as many, evenly spread, as is affordable.
    fn parts(&self, frames: &[Frame]) -> Vec<(u32, u32)> {
        match self.level {
            _ if frames.is_empty() => Vec::new(),
            Level::Rcm { .. } | Level::Full => vec![(0, 0)],
            Level::Rpu => {
                let (width, height) = (self.design.width(), self.design.height());
                let columns = self.whole.width().div_ceil(width);
                let tiles = u64::from(columns) * u64::from(self.whole.height().div_ceil(height));
                let clocks = frames.len() as u64 * self.timing.clocks_per_frame();
                let affordable = (MAX_CLOCKS / clocks.max(1)).clamp(1, tiles);
                let corner = |number: u64| {
                    let tile = number * tiles / affordable;
                    let tile = u32::try_from(tile).expect("a frame has few tiles");
                    (tile % columns * width, tile / columns * height)
                };
                (0..affordable).map(corner).collect()
            }
        }
    }

    /// A part of the caller's frames, back to back.
    fn given(
        &mut self,
        number: usize,
        (left, top): (u32, u32),
        frames: &[Frame],
    ) -> Result<(), CosimError> {
        let gaps = Gaps::ALL[number % Gaps::ALL.len()];
        let mood = self.mood(false, number);
        let name = match self.level {
            Level::Rpu => format!("frames from x {left}, y {top} on"),
            Level::Rcm { .. } | Level::Full => "frames".to_owned(),
        };
        self.driver.name(&name, 0);
        self.driver.begin(FrameAim::Design, mood, Lapse::None)?;
        let size = (self.design.width(), self.design.height());
        for (number, frame) in (0..).zip(frames) {
            if number > 0 {
                self.driver.name(&name, number);
            }
            let part = parts::cut(&self.design, frame, size, |x, y| (left + x, top + y))?;
            self.driver.take(&part, Until::End, gaps)?;
        }
        self.driver.drain()?;
        self.driver.idle(SILENCE)
    }
}
