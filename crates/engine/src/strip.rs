// SPDX-License-Identifier: MIT OR Apache-2.0
//! A strip: consecutive bands, the share of one worker in a batch of frames.
//!
//! The state that is kept between frames belongs to single regions, and windows see only raw pixels
//! of the same frame in other regions. So a strip goes through all frames of a batch without
//! waiting for the others.

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

/// The work that was skipped.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Skipped {
    /// The number of regions whose results cannot have changed.
    pub(crate) regions: usize,
    /// The number of blocks that were left out. A block is computed if one of its regions needs it.
    pub(crate) blocks: usize,
}

impl AddAssign for Skipped {
    fn add_assign(&mut self, other: Self) {
        self.regions += other.regions;
        self.blocks += other.blocks;
    }
}

/// A strip's part of the results that are kept of one frame.
#[derive(Debug)]
pub(crate) struct Kept<'a, T> {
    pub(crate) results: Results<'a>,
    /// The screen, or empty if screens are not kept.
    pub(crate) screen: &'a mut [T],
    /// The regions of the screen that are black.
    pub(crate) black: &'a mut [bool],
}

/// A task that takes a batch of frames through some bands.
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
    /// The regions whose summary the screen shows; empty if irrelevant regions send no summaries.
    pub(crate) shown: &'a mut [bool],
    pub(crate) means: &'a mut [T],
    /// One flag per band: the same raw pixels once more would change no result, reference or pixel
    /// of the screen.
    pub(crate) settled: &'a mut [bool],
    /// The results of the last frame.
    pub(crate) results: Results<'a>,
    /// The kept results of each frame, or empty.
    pub(crate) kept: Vec<Kept<'a, T>>,
    pub(crate) scratch: &'a mut Scratch<T>,
    pub(crate) changes: Changes<'a>,
    /// The skipped work of each frame.
    pub(crate) skipped: &'a mut Vec<Skipped>,
}

impl<T: Lane> Task for Strip<'_, T> {
    #[inline(always)]
    fn run(self) {
        // The function is compiled twice, so that cameras without a periphery do not pay for it.
        match self.plan.periphery {
            Some(_) => self.run_as::<true>(),
            None => self.run_as::<false>(),
        }
    }
}

impl<T: Lane> Strip<'_, T> {
    /// Takes all frames through the strip. `PERIPHERY` is true if irrelevant regions send their
    /// means.
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
                // The band that has just been written is not copied yet, because its stores are
                // still under way.
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

    /// Takes a frame through the strip's band number `row`.
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
        // From the second still frame on, counts and actions repeat.
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

    /// Chooses the runs of band `number` that have to be computed.
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

    /// Copies a band of the screen to the kept screen while it is in the cache.
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
