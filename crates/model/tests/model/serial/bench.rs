// SPDX-License-Identifier: MIT OR Apache-2.0
//! A bench that applies frames to an array and compares every port after every edge.

use foveate_design::FeatureKind;
use foveate_frame::Frame;
use foveate_model::{CoreInput, SerialRcm, Thresholds, pad, region_stream};

use super::recipe::SerialRecipe;
use super::waveform::{Facts, Shown, Timeline};
use crate::frames::Random;

/// The pattern in which pixels come.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Manner {
    /// Percentage of clocks without a pixel although the array is ready.
    pub(crate) gaps: i64,
    /// Longest pause between frames in clocks.
    pub(crate) between: i64,
    /// Percentage of clocks with a pixel although the array is not ready.
    pub(crate) pushing: i64,
    /// True if clocks without inputs are skipped at once.
    pub(crate) skips: bool,
    pub(crate) seed: u64,
}

impl Manner {
    pub(crate) const DENSE: Self = Self { gaps: 0, between: 0, pushing: 0, skips: false, seed: 0 };
}

/// The pixels of a frame in the order of the ports, and the expected results.
pub(crate) struct Job {
    pub(crate) pixels: Vec<Vec<u16>>,
    pub(crate) thresholds: Thresholds,
    pub(crate) facts: Vec<Facts>,
}

/// The result of a check: a description of the first difference, if there is one.
pub(crate) type Check = Result<(), String>;

pub(crate) struct Bench {
    pub(crate) recipe: SerialRecipe,
    pub(crate) rcm: SerialRcm,
    timeline: Timeline,
    manner: Manner,
    random: Random,
    /// The number of the last edge.
    pub(crate) edge: i64,
    /// The edge after which the run ends.
    until: i64,
    /// Thresholds that are applied between frames.
    noise: Thresholds,
    /// The number of clocks by which all expectations are late. It is 0 unless a test wants an
    /// error.
    pub(crate) late: i64,
}

impl Bench {
    pub(crate) fn new(recipe: &SerialRecipe, rcm: SerialRcm, manner: Manner) -> Self {
        Self {
            rcm,
            timeline: Timeline::default(),
            manner,
            random: Random(manner.seed),
            edge: 0,
            until: i64::MAX,
            noise: Thresholds::of(&recipe.design()),
            late: 0,
            recipe: recipe.clone(),
        }
    }

    /// Stops the run at that edge, whatever is under way.
    pub(crate) fn stop_after(&mut self, edge: i64) {
        self.until = edge;
    }

    fn is_over(&self) -> bool {
        self.edge >= self.until
    }

    /// Feeds the frames, each until all of its outputs have come.
    pub(crate) fn run(&mut self, jobs: &[Job]) -> Check {
        for job in jobs {
            let pause = self.random.below(self.manner.between + 1);
            self.shake();
            self.idle(pause, &self.noise.clone())?;
            self.feed(job)?;
            self.wait(&job.thresholds)?;
        }
        self.idle(3, &self.noise.clone())
    }

    fn feed(&mut self, job: &Job) -> Check {
        for (pixel, pixels) in job.pixels.iter().enumerate() {
            self.wait(&job.thresholds)?;
            while self.random.below(100) < self.manner.gaps {
                self.idle(1, &job.thresholds)?;
            }
            if self.is_over() {
                return Ok(());
            }
            let last = pixel + 1 == job.pixels.len();
            let facts = last.then_some(&job.facts[..]);
            self.timeline.take(&self.recipe, self.edge + 1, pixel as i64, facts);
            self.step(false, true, pixels, &job.thresholds)?;
        }
        Ok(())
    }

    /// Waits until the array is ready again.
    fn wait(&mut self, thresholds: &Thresholds) -> Check {
        while !self.timeline.ready(self.edge) && !self.is_over() {
            if self.manner.skips && self.random.below(3) > 0 {
                let left = self.timeline.ready_from - self.edge;
                let longest = if self.random.below(2) == 0 { 9 } else { left + 2 };
                let clocks = 1 + self.random.below(longest);
                self.skip(clocks)?;
                continue;
            }
            let pushed = self.random.below(100) < self.manner.pushing;
            let junk = self.junk();
            self.step(false, pushed, &junk, thresholds)?;
        }
        Ok(())
    }

    fn idle(&mut self, clocks: i64, thresholds: &Thresholds) -> Check {
        for _ in 0..clocks {
            if !self.is_over() {
                let junk = self.junk();
                self.step(false, false, &junk, thresholds)?;
            }
        }
        Ok(())
    }

    pub(crate) fn reset(&mut self, valid: bool) -> Check {
        self.timeline.reset(self.edge + 1);
        let junk = self.junk();
        self.shake();
        self.step(true, valid, &junk, &self.noise.clone())
    }

    fn step(&mut self, reset: bool, valid: bool, pixels: &[u16], thresholds: &Thresholds) -> Check {
        self.edge += 1;
        self.rcm.step(&CoreInput { reset, valid, ..CoreInput::idle(pixels, thresholds) });
        self.compare()
    }

    fn skip(&mut self, clocks: i64) -> Check {
        self.edge += clocks;
        self.rcm.skip(clocks as u64);
        self.compare()
    }

    fn compare(&self) -> Check {
        let (edge, output) = (self.edge, self.rcm.output());
        if output.ready != self.timeline.ready(edge) {
            return Err(format!("ready_o is {} after edge {edge}", output.ready));
        }
        let (shown, due) = (Shown::by(output), self.timeline.shown(edge - self.late));
        if shown != due {
            return Err(format!("after edge {edge}: {shown:?}, due is {due:?}"));
        }
        Ok(())
    }

    /// Changes the thresholds between frames, which the array must ignore.
    fn shake(&mut self) {
        self.noise.temporal_level = self.random.below(2) as u32;
        self.noise.temporal_min_count = self.random.below(5) as u32;
        self.noise.summary_level = self.random.below(2) as u32;
        self.noise.level = [self.random.below(9) as u32; FeatureKind::COUNT];
        self.noise.min_score = [self.random.below(9) as u64; FeatureKind::COUNT];
    }

    /// Returns pixels that the array must ignore.
    fn junk(&mut self) -> Vec<u16> {
        let top = self.recipe.base.pixel_max() + 1;
        let seed = self.random.below(top);
        let ports = 0..self.rcm.output().forward_valid.len() as i64;
        ports.map(|port| ((seed + port) % top) as u16).collect()
    }
}

/// Returns the pixels of a frame in the order of the ports. A lane with an empty slot gets the
/// pixels of another region.
pub(crate) fn applied(recipe: &SerialRecipe, frame: &Frame) -> Vec<Vec<u16>> {
    let design = recipe.design();
    let padded = pad(&design, frame).unwrap();
    if recipe.raster {
        return padded.pixels().iter().map(|&pixel| vec![pixel]).collect();
    }
    let stream = |region: i64| {
        let mut pixels = Vec::new();
        let anything = region.min(recipe.regions() - 1) as u32;
        region_stream(&design, frame, anything, &mut pixels);
        pixels
    };
    let streams: Vec<Vec<u16>> = (0..recipe.lanes() * recipe.fold).map(stream).collect();
    by_port(recipe, &streams)
}

/// Converts streams by region to the order of the lanes.
pub(crate) fn by_port(recipe: &SerialRecipe, streams: &[Vec<u16>]) -> Vec<Vec<u16>> {
    let mut pixels = Vec::new();
    for slot in 0..recipe.fold {
        let lane = |lane: i64| &streams[(lane * recipe.fold + slot) as usize];
        let lanes: Vec<&Vec<u16>> = (0..recipe.lanes()).map(lane).collect();
        let at = |place| lanes.iter().map(|stream| stream[place]).collect();
        pixels.extend((0..streams[0].len()).map(at));
    }
    pixels
}
