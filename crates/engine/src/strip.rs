// SPDX-License-Identifier: MIT OR Apache-2.0
//! Consecutive bands as one worker's share of a batch of frames.
//!
//! What is kept between frames belongs to a region, and what is seen of other regions are raw pixels
//! of the same frame: so a strip goes through all frames of a batch without waiting for the others.

use std::ops::{AddAssign, Range};

use crate::band::Band;
use crate::change;
use crate::look::Changes;
use crate::outcome::{Results, within};
use crate::periphery::{Means, Summaries};
use crate::pixels::Pixels;
use crate::plan::CameraPlan;
use crate::render::{Canvas, show};
use crate::scratch::Scratch;
use foveate_lanes::Lane;
use foveate_lanes::Task;

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

/// A strip's part of what is kept of one frame.
#[derive(Debug)]
pub(crate) struct Kept<'a, T> {
    pub(crate) results: Results<'a>,
    /// Empty where the screen is not asked for.
    pub(crate) screen: &'a mut [T],
    /// Regions of it that are black.
    pub(crate) black: &'a mut [bool],
}

/// Takes a batch of frames through some bands.
#[derive(Debug)]
pub(crate) struct Strip<'a, T: Lane> {
    pub(crate) plan: &'a CameraPlan<T>,
    pub(crate) frames: &'a [Pixels<'a, T>],
    pub(crate) bands: Range<usize>,
    pub(crate) denoised: &'a mut [T],
    pub(crate) reference: &'a mut [T],
    pub(crate) screen: &'a mut [T],
    pub(crate) valid: &'a mut [bool],
    pub(crate) black: &'a mut [bool],
    /// Regions whose summary the screen shows, and its means; empty where irrelevant regions send none.
    pub(crate) shown: &'a mut [bool],
    pub(crate) means: &'a mut [T],
    /// By band: no result, reference or pixel of the screen would change if it stood still again.
    pub(crate) settled: &'a mut [bool],
    /// Of the last frame.
    pub(crate) results: Results<'a>,
    /// By frame, or empty.
    pub(crate) kept: Vec<Kept<'a, T>>,
    pub(crate) scratch: &'a mut Scratch<T>,
    pub(crate) changes: Changes<'a>,
    /// By frame.
    pub(crate) skipped: &'a mut Vec<Skipped>,
}

impl<T: Lane> Task for Strip<'_, T> {
    #[inline(always)]
    fn run(self) {
        // Twice, so that what a periphery needs costs nothing where there is none.
        match self.plan.periphery {
            Some(_) => self.run_as::<true>(),
            None => self.run_as::<false>(),
        }
    }
}

impl<T: Lane> Strip<'_, T> {
    /// `PERIPHERY`: whether irrelevant regions send their means.
    #[inline(always)]
    fn run_as<const PERIPHERY: bool>(mut self) {
        self.skipped.clear();
        for frame in 0..self.frames.len() {
            for row in &mut self.scratch.denoised {
                row.holds = None;
            }
            self.skipped.push(Skipped::default());
            for row in 0..self.bands.len() {
                self.band::<PERIPHERY>(frame, row);
                // Not the band that has only just been written: its stores are still on their way.
                if let Some(last) = row.checked_sub(1) {
                    self.keep_screen(frame, last);
                }
            }
            self.keep_screen(frame, self.bands.len() - 1);
            if let Some(kept) = self.kept.get_mut(frame) {
                kept.results.copy_from(&self.results);
            }
        }
    }

    /// Takes a frame through the strip's `row`th band.
    #[inline(always)]
    fn band<const PERIPHERY: bool>(&mut self, frame: usize, row: usize) {
        let (plan, raw, number) = (self.plan, self.frames[frame], self.bands.start + row);
        let rows = row * plan.side * plan.stride()..(row + 1) * plan.side * plan.stride();
        let regions = row * plan.columns..(row + 1) * plan.columns;
        let lines = row * plan.side * plan.width;
        self.select(frame, number);
        let still = self.scratch.runs.is_empty();
        if still && self.settled[row] {
            return;
        }
        // Any count and action is followed by the same ones from the second still frame on.
        self.settled[row] = still && plan.reference.settles();
        let reference = rows.start.min(self.reference.len())..rows.end.min(self.reference.len());
        if !still {
            let mut band = Band {
                plan,
                raw,
                number,
                denoised: &mut self.denoised[rows.clone()],
                reference: &self.reference[reference.clone()],
            };
            band.measure::<PERIPHERY>(self.scratch);
        }
        let mut results = self.results.rows(regions.clone());
        let valid = &mut self.valid[regions.clone()];
        plan.decide(&self.scratch.sums, &self.scratch.affected, valid, &mut results);
        let means = row * plan.band_means()..(row + 1) * plan.band_means();
        let means = &mut self.means[means];
        if PERIPHERY && let Some(periphery) = &plan.periphery {
            let shown = &mut self.shown[regions.clone()];
            let Scratch { means: now, differs, affected, .. } = &mut *self.scratch;
            let now = Means { means: now, differs, affected };
            periphery.summarize(now, &mut Summaries { shown, means }, &mut results);
        }
        let mut canvas = Canvas {
            screen: &mut self.screen[lines..],
            denoised: &self.denoised[rows],
            reference: &mut self.reference[reference],
            valid,
            black: &mut self.black[regions],
            means,
        };
        canvas.act::<PERIPHERY>(plan, raw, number, results.actions);
    }

    /// Chooses what of band `number` has to be computed.
    #[inline(always)]
    fn select(&mut self, frame: usize, number: usize) {
        let (plan, scratch) = (self.plan, &mut *self.scratch);
        match self.changes.around(plan, frame, number) {
            Some(changed) => {
                change::affected(plan, changed, &mut scratch.affected);
                change::runs(plan, &scratch.affected, &mut scratch.runs);
                let computed: usize = scratch.runs.iter().map(Range::len).sum();
                let skipped = scratch.affected.iter().filter(|affected| !**affected).count();
                self.skipped[frame] += Skipped { regions: skipped, blocks: plan.blocks - computed };
            }
            None => {
                scratch.affected.fill(true);
                scratch.runs.clear();
                scratch.runs.push(0..plan.blocks);
            }
        }
    }

    /// Copies what is on the screen, where it is kept, while it is in the cache.
    #[inline(always)]
    fn keep_screen(&mut self, frame: usize, row: usize) {
        let plan = self.plan;
        if let Some(kept) = self.kept.get_mut(frame) {
            let regions = row * plan.columns..(row + 1) * plan.columns;
            let black = within(kept.black, &regions);
            if !black.is_empty() {
                let top = row * plan.side * plan.width;
                let screen = (&self.screen[top..], &self.black[regions]);
                show(plan, self.bands.start + row, screen, (&mut kept.screen[top..], black));
            }
        }
    }
}
