// SPDX-License-Identifier: MIT OR Apache-2.0
//! Consecutive bands as one worker's share of a frame.

use std::ops::{AddAssign, Range};

use crate::band::Band;
use crate::change;
use crate::outcome::Results;
use crate::pixels::Pixels;
use crate::plan::Plan;
use crate::policy::Step;
use crate::render::Canvas;
use crate::scratch::Scratch;
use foveate_lanes::Lane;
use foveate_lanes::Task;

/// Finds what has changed in some bands.
#[derive(Debug)]
pub(crate) struct Look<'a, T: Lane> {
    pub(crate) plan: &'a Plan<T>,
    pub(crate) raw: Pixels<'a, T>,
    pub(crate) bands: Range<usize>,
    pub(crate) step: Step,
    /// Their part of the last frame.
    pub(crate) copy: &'a mut [T],
    pub(crate) changed: &'a mut [bool],
}

impl<T: Lane> Task for Look<'_, T> {
    #[inline(always)]
    fn run(self) {
        let Self { plan, raw, bands, step, copy, changed } = self;
        let copies = copy.chunks_mut(plan.side * plan.width);
        let bands = bands.zip(copies).zip(changed.chunks_exact_mut(plan.columns));
        for ((band, copy), changed) in bands {
            if !step.concerns(band) {
                continue;
            }
            match step {
                Step::Rest => {}
                Step::Sample | Step::Keep => change::keep(plan, raw, band, copy),
                Step::Judge | Step::Compare => change::compare(plan, raw, band, copy, changed),
            }
        }
    }
}

/// What did not have to be computed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Skipped {
    /// Regions whose results cannot have changed.
    pub(crate) regions: usize,
    /// Blocks that were left out: a block is computed for each of its regions that needs it.
    pub(crate) blocks: usize,
}

impl AddAssign for Skipped {
    fn add_assign(&mut self, other: Self) {
        self.regions += other.regions;
        self.blocks += other.blocks;
    }
}

/// Takes one frame through some bands.
#[derive(Debug)]
pub(crate) struct Strip<'a, T: Lane> {
    pub(crate) plan: &'a Plan<T>,
    pub(crate) raw: Pixels<'a, T>,
    pub(crate) bands: Range<usize>,
    pub(crate) denoised: &'a mut [T],
    pub(crate) reference: &'a mut [T],
    pub(crate) screen: &'a mut [T],
    pub(crate) valid: &'a mut [bool],
    pub(crate) black: &'a mut [bool],
    /// By band: no result, reference or pixel of the screen would change if it stood still again.
    pub(crate) settled: &'a mut [bool],
    pub(crate) results: Results<'a>,
    pub(crate) scratch: &'a mut Scratch<T>,
    /// Which regions of the frame have changed, where that is known.
    pub(crate) changed: Option<&'a [bool]>,
    pub(crate) skipped: &'a mut Skipped,
}

impl<T: Lane> Task for Strip<'_, T> {
    #[inline(always)]
    fn run(mut self) {
        for row in &mut self.scratch.denoised {
            row.holds = None;
        }
        *self.skipped = Skipped::default();
        let bands = self.bands.clone();
        for (row, band) in bands.enumerate() {
            self.band(row, band);
        }
    }
}

impl<T: Lane> Strip<'_, T> {
    /// Band `number`, the strip's `row`th.
    #[inline(always)]
    fn band(&mut self, row: usize, number: usize) {
        let plan = self.plan;
        let rows = row * plan.side * plan.stride()..(row + 1) * plan.side * plan.stride();
        let regions = row * plan.columns..(row + 1) * plan.columns;
        let lines = row * plan.side * plan.width;
        self.select(number);
        let still = self.scratch.runs.is_empty();
        if still && self.settled[row] {
            return;
        }
        // Any count and action is followed by the same ones from the second still frame on.
        self.settled[row] = still;
        let reference = rows.start.min(self.reference.len())..rows.end.min(self.reference.len());
        if !still {
            let mut band = Band {
                plan,
                raw: self.raw,
                number,
                denoised: &mut self.denoised[rows.clone()],
                reference: &self.reference[reference.clone()],
            };
            band.measure(self.scratch);
        }
        let mut results = self.results.rows(regions.clone());
        let valid = &mut self.valid[regions.clone()];
        plan.decide(&self.scratch.sums, &self.scratch.affected, valid, &mut results);
        let mut canvas = Canvas {
            screen: &mut self.screen[lines..],
            denoised: &self.denoised[rows],
            reference: &mut self.reference[reference],
            valid,
            black: &mut self.black[regions],
        };
        canvas.act(plan, self.raw, number, results.actions);
    }

    /// Chooses what of band `number` has to be computed.
    #[inline(always)]
    fn select(&mut self, number: usize) {
        let (plan, scratch) = (self.plan, &mut *self.scratch);
        match self.changed {
            Some(changed) => {
                change::affected(plan, changed, number, &mut scratch.affected);
                change::runs(plan, &scratch.affected, &mut scratch.runs);
                let computed: usize = scratch.runs.iter().map(Range::len).sum();
                let skipped = scratch.affected.iter().filter(|affected| !**affected).count();
                *self.skipped += Skipped { regions: skipped, blocks: plan.blocks - computed };
            }
            None => {
                scratch.affected.fill(true);
                scratch.runs.clear();
                scratch.runs.push(0..plan.blocks);
            }
        }
    }
}
