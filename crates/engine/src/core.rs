// SPDX-License-Identifier: MIT OR Apache-2.0
//! The engine for one lane width: the planes that are kept between frames, and their division among
//! workers.

use std::iter;
use std::ops::Range;

use foveate_camera::Reference;

use crate::change;
use crate::look::{Changes, Look};
use crate::memory::{Known, Memory};
use crate::outcome::{FrameOutcome, split_off};
use crate::pixels::Pixels;
use crate::plan::CameraPlan;
use crate::policy::{Policy, SAMPLE, Step};
use crate::scratch::Scratch;
use crate::screens::Screen;
use crate::strip::{Kept, Skipped, Strip};
use crate::workers::Workers;
use foveate_lanes::Aligned;
use foveate_lanes::Lane;

/// The number of rows of the smallest strip.
const SMALLEST_HEIGHT: usize = 96;

/// The state that is kept between frames.
#[derive(Debug)]
pub(crate) struct Core<T: Lane> {
    pub(crate) plan: CameraPlan<T>,
    denoised: Aligned<T>,
    reference: Aligned<T>,
    pub(crate) screen: Vec<T>,
    valid: Vec<bool>,
    black: Vec<bool>,
    /// The regions whose summary the screen shows.
    shown: Vec<bool>,
    means: Vec<T>,
    settled: Vec<bool>,
    /// The last frame without padding. It is kept up to date while the policy asks for it.
    copy: Vec<T>,
    /// One flag per region and frame, in the order band, frame, column: its pixels have changed.
    changed: Vec<bool>,
    policy: Policy,
    skip: bool,
    /// A copy of the state before the last step, if the caller asked for it.
    memory: Option<Memory<T>>,
    /// The working memory and the skip counts of each strip.
    scratch: Vec<(Scratch<T>, Vec<Skipped>)>,
}

/// The buffers for results that are kept of every frame of a batch. They are empty if nothing is
/// kept.
#[derive(Debug)]
pub(crate) struct Keep<'a, T> {
    pub(crate) outcomes: &'a mut [FrameOutcome],
    /// One screen per frame, or none.
    pub(crate) screens: &'a mut [Screen<T>],
}

impl<T> Keep<'_, T> {
    pub(crate) fn nothing() -> Self {
        Self { outcomes: &mut [], screens: &mut [] }
    }
}

impl<T: Lane> Core<T> {
    pub(crate) fn new(plan: CameraPlan<T>, skip: bool) -> Self {
        let plane = plan.stride() * plan.rows * plan.side;
        let reference = match plan.reference {
            Reference::Previous => 0,
            Reference::LastSent => plane,
        };
        Self {
            denoised: Aligned::new(plane),
            reference: Aligned::new(reference),
            screen: vec![T::default(); plan.width * plan.height],
            valid: vec![false; plan.regions()],
            black: vec![true; plan.regions()],
            shown: vec![false; if plan.periphery.is_some() { plan.regions() } else { 0 }],
            means: vec![T::default(); plan.rows * plan.band_means()],
            settled: vec![false; plan.rows],
            copy: vec![T::default(); if skip { plan.width * plan.height } else { 0 }],
            changed: Vec::new(),
            policy: Policy::new(skip),
            skip,
            memory: None,
            scratch: vec![(Scratch::new(&plan), Vec::new())],
            plan,
        }
    }

    pub(crate) fn reset(&mut self) {
        self.valid.fill(false);
        self.black.fill(true);
        self.shown.fill(false);
        self.settled.fill(false);
        self.screen.fill(T::default());
        if let Some(memory) = &mut self.memory {
            *memory = Memory::default();
        }
        self.policy = Policy::new(self.skip);
    }

    /// Appends the denoised pixels of a region.
    pub(crate) fn denoised_region(&self, region: u32, pixels: &mut Vec<u16>) {
        self.plan.pixels_of(&self.denoised, region, pixels);
    }

    /// Appends the means that a region sent last.
    pub(crate) fn summary(&self, region: u32, means: &mut Vec<u16>) {
        self.plan.means_of(&self.means, region, means);
    }

    /// Turns the copy of the state before every step on or off.
    pub(crate) fn remember(&mut self, on: bool) {
        match (on, &self.memory) {
            (true, None) => self.memory = Some(Memory::default()),
            (true, Some(_)) => {}
            (false, _) => self.memory = None,
        }
    }

    /// Returns the state before the last step, if it was copied.
    pub(crate) fn memory(&self) -> Option<&Memory<T>> {
        self.memory.as_ref().filter(|memory| memory.is_taken())
    }

    fn take_memory(&mut self) {
        let Self { plan, denoised, reference, valid, shown, means, screen, memory, .. } = self;
        if let Some(memory) = memory {
            memory.take(plan, &Known { denoised, reference, valid, shown, means, screen });
        }
    }

    /// Takes the next frames. `outcome` becomes the outcome of the last one.
    pub(crate) fn step(
        &mut self,
        frames: &[Pixels<'_, T>],
        workers: &Workers,
        outcome: &mut FrameOutcome,
        keep: Keep<'_, T>,
    ) {
        self.take_memory();
        self.divide(frames.len(), workers);
        let first = self.look(frames, workers);
        self.compute(frames, workers, first, outcome, keep);
    }

    /// Sets the number of strips to what the frames are worth.
    fn divide(&mut self, frames: usize, workers: &Workers) {
        let plan = &self.plan;
        let pixels = plan.stride() * plan.rows * plan.side * frames;
        // A strip denoises one row of each neighbor again, which does not pay for a few rows.
        let most = (plan.rows * plan.side / SMALLEST_HEIGHT).clamp(1, plan.rows);
        let strips = workers.strips(most, pixels);
        self.scratch.resize_with(strips, || (Scratch::new(plan), Vec::new()));
    }

    /// Finds the regions that have changed, if the search pays. Returns the number of the first
    /// frame whose changes are known.
    fn look(&mut self, frames: &[Pixels<'_, T>], workers: &Workers) -> usize {
        let step = self.policy.next(frames.len());
        if step == Step::Rest {
            return frames.len();
        }
        self.changed.resize(self.plan.regions() * frames.len(), true);
        self.look_as(step, frames, workers);
        match step {
            Step::Compare => 0,
            Step::Judge(frame) => {
                let (saved, blocks) = self.sample(frame, frames.len());
                if self.policy.judge(saved, blocks) {
                    self.look_as(Step::Keep, frames, workers);
                    return 1;
                }
                frames.len()
            }
            Step::Rest | Step::Sample | Step::Keep => frames.len(),
        }
    }

    fn look_as(&mut self, step: Step, frames: &[Pixels<'_, T>], workers: &Workers) {
        let plan = &self.plan;
        let (mut copy, mut changed) = (&mut self.copy[..], &mut self.changed[..]);
        let looks = shares(plan.rows, self.scratch.len()).map(|bands| Look {
            plan,
            frames,
            step,
            copy: split_off(&mut copy, bands.len() * plan.side * plan.width),
            changed: split_off(&mut changed, bands.len() * plan.columns * frames.len()),
            bands,
        });
        workers.run(looks);
    }

    /// Returns how many blocks of the sample one frame could save, and the number of blocks of the
    /// sample.
    fn sample(&self, frame: usize, frames: usize) -> (usize, usize) {
        let plan = &self.plan;
        let (mut saved, mut blocks, mut runs) = (0, 0, Vec::new());
        let bands = self.changed.chunks_exact(plan.columns * frames).step_by(SAMPLE);
        for changed in bands.map(|band| &band[frame * plan.columns..][..plan.columns]) {
            change::runs(plan, changed, &mut runs);
            saved += plan.blocks - runs.iter().map(Range::len).sum::<usize>();
            blocks += plan.blocks;
        }
        (saved, blocks)
    }

    /// Takes the frames through all strips. Changes are known from frame `first` on.
    fn compute(
        &mut self,
        frames: &[Pixels<'_, T>],
        workers: &Workers,
        first: usize,
        outcome: &mut FrameOutcome,
        keep: Keep<'_, T>,
    ) {
        let plan = &self.plan;
        let changes = Changes { changed: &self.changed, frames: frames.len(), first };
        let (mut denoised, mut reference) = (&mut self.denoised[..], &mut self.reference[..]);
        let (mut valid, mut black) = (&mut self.valid[..], &mut self.black[..]);
        let (mut shown, mut means) = (&mut self.shown[..], &mut self.means[..]);
        let (mut settled, mut screen) = (&mut self.settled[..], &mut self.screen[..]);
        let mut results = outcome.results();
        let Keep { outcomes, screens } = keep;
        let screens = screens.iter_mut();
        let screens = screens.map(|screen| (&mut screen.pixels[..], &mut screen.black[..]));
        let screens = screens.chain(iter::repeat_with(|| (&mut [][..], &mut [][..])));
        let kept = outcomes.iter_mut().map(FrameOutcome::results).zip(screens);
        let mut kept: Vec<_> =
            kept.map(|(results, (screen, black))| Kept { results, screen, black }).collect();
        let bands = shares(plan.rows, self.scratch.len());
        let strips = bands.zip(&mut self.scratch).map(|(bands, (scratch, skipped))| {
            let (rows, regions) = (bands.len() * plan.side, bands.len() * plan.columns);
            let kept = kept.iter_mut().map(|kept| Kept {
                results: kept.results.split_off(regions),
                screen: split_off(&mut kept.screen, rows * plan.width),
                black: split_off(&mut kept.black, regions),
            });
            Strip {
                plan,
                frames,
                denoised: split_off(&mut denoised, rows * plan.stride()),
                reference: split_off(&mut reference, rows * plan.stride()),
                screen: split_off(&mut screen, rows * plan.width),
                valid: split_off(&mut valid, regions),
                black: split_off(&mut black, regions),
                shown: split_off(&mut shown, regions),
                means: split_off(&mut means, bands.len() * plan.band_means()),
                settled: split_off(&mut settled, bands.len()),
                bands,
                results: results.split_off(regions),
                kept: kept.collect(),
                scratch,
                changes,
                skipped,
            }
        });
        workers.run(strips);
        self.count_skipped(first..frames.len(), outcome, outcomes);
    }

    /// Adds up what the strips have skipped, and reports it to the policy.
    fn count_skipped(
        &mut self,
        known: Range<usize>,
        last: &mut FrameOutcome,
        outcomes: &mut [FrameOutcome],
    ) {
        let frame = |number: usize| {
            let mut all = Skipped::default();
            self.scratch.iter().for_each(|(_, skipped)| all += skipped[number]);
            all
        };
        for (number, outcome) in outcomes.iter_mut().enumerate() {
            outcome.skipped = frame(number).regions;
        }
        last.skipped = frame(known.end - 1).regions;
        if !known.is_empty() {
            let blocks = self.plan.blocks * self.plan.rows * known.len();
            self.policy.saved(known.map(|number| frame(number).blocks).sum(), blocks);
        }
    }
}

/// Divides all bands among the strips, in shares that differ by at most one band.
fn shares(bands: usize, strips: usize) -> impl ExactSizeIterator<Item = Range<usize>> {
    (0..strips).map(move |strip| bands * strip / strips..bands * (strip + 1) / strips)
}
