// SPDX-License-Identifier: MIT OR Apache-2.0
//! A driver that feeds frames to a core, word by word, in front of a sink that is not always ready.
//! It records inputs and outputs.

use foveate_design::FeatureKind;
use foveate_frame::Frame;
use foveate_model::{CoreInput, RasterOutput, RasterRcm, Thresholds};

use super::memory::{Faults, Memory};
use super::recipe::RasterRecipe;
use crate::frames::Random;

/// The clocks at which the sink is ready.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sink {
    /// The sink is ready in this percentage of clocks, at random.
    Often(i64),
    /// The sink is alternately ready and not ready for up to this number of clocks.
    Turns(i64),
}

/// The pattern in which words come and leave.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Manner {
    /// Percentage of clocks without a word although the core is ready.
    pub(crate) gaps: i64,
    /// Longest pause between frames in clocks.
    pub(crate) between: i64,
    /// Percentage of clocks with a word although the core is not ready.
    pub(crate) pushing: i64,
    pub(crate) sink: Sink,
    /// Faults of the external memory, if there is one.
    pub(crate) faults: Faults,
    pub(crate) seed: u64,
}

impl Manner {
    pub(crate) const DENSE: Self = Self {
        gaps: 0,
        between: 0,
        pushing: 0,
        sink: Sink::Often(100),
        faults: Faults::NONE,
        seed: 0,
    };
}

/// A frame with its thresholds.
pub(crate) struct Job {
    pub(crate) frame: Frame,
    pub(crate) thresholds: Thresholds,
}

/// The inputs and outputs since a reset. Element x belongs to edge x, and element 0 to the time
/// before the first edge.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trace {
    pub(crate) valid: Vec<bool>,
    pub(crate) sink: Vec<bool>,
    /// The references and their valid bits, if the core has these ports.
    pub(crate) references: Vec<(bool, Vec<u16>)>,
    pub(crate) shown: Vec<RasterOutput>,
}

impl Trace {
    /// Returns the number of the last edge.
    pub(crate) fn end(&self) -> i64 {
        self.shown.len() as i64 - 1
    }
}

pub(crate) struct Driver {
    recipe: RasterRecipe,
    pub(crate) rcm: RasterRcm,
    manner: Manner,
    memory: Memory,
    random: Random,
    trace: Trace,
    /// Clocks that are left until the run ends.
    left: i64,
    /// Clocks left of the current phase of the sink, and true if the sink is ready in it.
    turn: (i64, bool),
    decisions: i64,
    noise: Thresholds,
}

impl Driver {
    pub(crate) fn new(recipe: &RasterRecipe, manner: Manner) -> Self {
        let design = recipe.design();
        let rcm = RasterRcm::new(design.raster().unwrap());
        let mut driver = Self {
            recipe: recipe.clone(),
            rcm,
            manner,
            memory: Memory::new(recipe, manner.faults, manner.seed),
            random: Random(manner.seed),
            trace: Trace::default(),
            left: i64::MAX,
            turn: (0, true),
            decisions: 0,
            noise: Thresholds::of(&design),
        };
        driver.begin();
        driver
    }

    /// Resets the core for some clocks, with random values at its ports.
    pub(crate) fn reset(&mut self, clocks: i64) {
        for _ in 0..clocks {
            let (word, thresholds) = (self.junk(), self.noise());
            let (valid, forward_ready) = (self.random.below(2) > 0, self.random.below(2) > 0);
            let input = CoreInput {
                reset: true,
                valid,
                sof: false,
                pixels: &word,
                reference_valid: false,
                reference_pixels: &word,
                forward_ready,
                thresholds: &thresholds,
                border: 0,
            };
            self.rcm.step(&input);
        }
        self.memory.forget();
        self.begin();
    }

    /// Starts a new record of inputs and outputs.
    pub(crate) fn begin(&mut self) {
        self.decisions = 0;
        let shown = vec![self.rcm.output().clone()];
        let references = vec![(false, Vec::new())];
        self.trace = Trace { valid: vec![false], sink: vec![false], references, shown };
    }

    /// Feeds the frames, lets `rest` clocks pass, and returns the record. The run ends after
    /// `clocks` clocks, whatever is under way.
    pub(crate) fn run(&mut self, jobs: &[Job], rest: i64, clocks: i64) -> Trace {
        self.left = clocks;
        for (number, job) in (1..).zip(jobs) {
            let pause = self.random.below(self.manner.between + 1);
            for _ in 0..pause {
                self.idle(&job.thresholds);
            }
            self.feed(job);
            // Thresholds may change only from here on.
            while !self.is_settled(number) && self.left > 0 {
                self.idle(&job.thresholds);
            }
        }
        for _ in 0..rest {
            let noise = self.noise();
            self.idle(&noise);
        }
        std::mem::take(&mut self.trace)
    }

    /// Returns true if the thresholds may change: without `mad` when the core is ready again, with
    /// `mad` after the last decision.
    fn is_settled(&self, frames: i64) -> bool {
        let regions = self.recipe.base.columns() * self.recipe.base.rows();
        let is_decided = self.decisions == frames * regions;
        self.rcm.output().ready && (is_decided || !self.recipe.has_mad())
    }

    fn feed(&mut self, job: &Job) {
        for word in words(&self.recipe, &job.frame, &mut self.random) {
            while !self.rcm.output().ready || self.random.below(100) < self.manner.gaps {
                if self.left == 0 {
                    return;
                }
                self.idle(&job.thresholds);
            }
            self.step(true, &word, &job.thresholds);
        }
    }

    fn idle(&mut self, thresholds: &Thresholds) {
        let junk = self.junk();
        let pushes = !self.rcm.output().ready && self.random.below(100) < self.manner.pushing;
        self.step(pushes, &junk, thresholds);
    }

    fn step(&mut self, valid: bool, pixels: &[u16], thresholds: &Thresholds) {
        if self.left == 0 {
            return;
        }
        self.left -= 1;
        let forward_ready = self.sink();
        let (reference_valid, reference) = self.memory.show(self.rcm.output());
        let input = CoreInput {
            reset: false,
            valid,
            sof: false,
            pixels,
            reference_valid,
            reference_pixels: &reference,
            forward_ready,
            thresholds,
            border: 0,
        };
        let shown = self.rcm.step(&input).clone();
        self.memory.store(&shown);
        self.trace.references.push((reference_valid, reference));
        self.decisions += i64::from(shown.decision_valid);
        self.trace.valid.push(valid);
        self.trace.sink.push(forward_ready);
        self.trace.shown.push(shown);
    }

    fn sink(&mut self) -> bool {
        match self.manner.sink {
            Sink::Often(percent) => self.random.below(100) < percent,
            Sink::Turns(longest) => {
                if self.turn.0 == 0 {
                    self.turn = (1 + self.random.below(longest), !self.turn.1);
                }
                self.turn.0 -= 1;
                self.turn.1
            }
        }
    }

    /// Returns a word that the core must ignore.
    fn junk(&mut self) -> Vec<u16> {
        let top = self.recipe.base.pixel_max() + 1;
        (0..self.recipe.pixels).map(|_| self.random.below(top) as u16).collect()
    }

    /// Returns thresholds that the core must ignore.
    fn noise(&mut self) -> Thresholds {
        let mut noise = self.noise;
        noise.temporal_level = self.random.below(2) as u32;
        noise.temporal_min_count = self.random.below(5) as u32;
        noise.summary_level = self.random.below(2) as u32;
        noise.level = [self.random.below(9) as u32; FeatureKind::COUNT];
        noise.min_score = [self.random.below(9) as u64; FeatureKind::COUNT];
        noise
    }
}

/// Returns the words of a frame. Pixels beyond its right border are random.
pub(crate) fn words(recipe: &RasterRecipe, frame: &Frame, random: &mut Random) -> Vec<Vec<u16>> {
    let top = recipe.base.pixel_max() + 1;
    let mut words = Vec::new();
    for y in 0..frame.height() {
        let mut row = frame.row(y).to_vec();
        row.resize((recipe.taken_of_row() * recipe.pixels) as usize, random.below(top) as u16);
        words.extend(row.chunks_exact(recipe.pixels as usize).map(<[u16]>::to_vec));
    }
    words
}
