// SPDX-License-Identifier: MIT OR Apache-2.0
//! A strip: consecutive bands, the share of one worker in a batch of frames.
//!
//! A strip goes through all frames of a batch without waiting for other strips. This is possible
//! because the state between frames belongs to single regions, and because windows read nothing of
//! other regions but raw pixels of the same frame.

use std::ops::{AddAssign, Range};

use foveate_camera::{Displacement, RegionClass};

use super::change::KnownChanges;
use super::receiver::{BandRenderer, keep_screen_band};
use crate::band::BandPass;
use crate::change;
use crate::outcome::{RegionResults, cut_to_range};
use crate::periphery::{CurrentMeans, SentSummaries};
use crate::pixels::BorrowedFrame;
use crate::plan::CameraPlan;
use crate::working_memory::WorkingMemory;
use foveate_pixels::{vectors::VectorPixel, vectors::VectorTask};

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SkippedWork {
    /// The number of regions whose results cannot have changed.
    pub(crate) regions: usize,
    /// The number of blocks that were left out. A block is computed if one of its regions needs it.
    pub(crate) blocks: usize,
}

impl AddAssign for SkippedWork {
    fn add_assign(&mut self, other: Self) {
        self.regions += other.regions;
        self.blocks += other.blocks;
    }
}

/// A strip's part of the results that are kept of one frame.
#[derive(Debug)]
pub(crate) struct KeptStripResults<'a, T> {
    pub(crate) results: RegionResults<'a>,
    /// The screen, or empty if screens are not kept.
    pub(crate) screen: &'a mut [T],
    /// The regions of the screen that are black.
    pub(crate) black: &'a mut [bool],
}

/// A task that takes a batch of frames through some bands.
#[derive(Debug)]
pub(crate) struct BandStrip<'a, T: VectorPixel> {
    pub(crate) plan: &'a CameraPlan<T>,
    pub(crate) frames: &'a [BorrowedFrame<'a, T>],
    pub(crate) bands: Range<usize>,
    pub(crate) denoised: &'a mut [T],
    pub(crate) reference: &'a mut [T],
    pub(crate) screen: &'a mut [T],
    pub(crate) reference_valid: &'a mut [bool],
    pub(crate) black_regions: &'a mut [bool],
    /// The regions whose summary the screen shows; empty if irrelevant regions send no summaries.
    pub(crate) summary_shown: &'a mut [bool],
    pub(crate) means: &'a mut [T],
    /// One flag per band: the same raw pixels once more would change no result, reference or pixel
    /// of the screen.
    pub(crate) is_settled: &'a mut [bool],
    /// The regions that were forgotten, or got another class, before the first frame. They are
    /// computed in that frame even if their pixels have not changed.
    pub(crate) must_compute: &'a mut [bool],
    /// The classes of the regions; empty if the camera has no zones.
    pub(crate) classes: &'a [RegionClass],
    /// The results of the last frame.
    pub(crate) results: RegionResults<'a>,
    /// The kept results of each frame, or empty.
    pub(crate) kept: Vec<KeptStripResults<'a, T>>,
    pub(crate) scratch: &'a mut WorkingMemory<T>,
    pub(crate) changes: KnownChanges<'a>,
    /// The skipped work of each frame.
    pub(crate) skipped: &'a mut Vec<SkippedWork>,
}

impl<T: VectorPixel> VectorTask for BandStrip<'_, T> {
    /// Takes all frames through the strip.
    #[inline(always)]
    fn run(mut self) {
        self.skipped.clear();
        for frame in 0..self.frames.len() {
            for row in &mut self.scratch.denoised {
                row.row_and_run = None;
            }
            self.skipped.push(SkippedWork::default());
            for row in 0..self.bands.len() {
                self.step_band(frame, row);
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
}

impl<T: VectorPixel> BandStrip<'_, T> {
    /// Takes a frame through the strip's band number `row`.
    #[inline(always)]
    fn step_band(&mut self, frame: usize, row: usize) {
        let (plan, raw, number) = (self.plan, self.frames[frame], self.bands.start + row);
        let rows = row * plan.side * plan.stride()..(row + 1) * plan.side * plan.stride();
        let regions = row * plan.columns..(row + 1) * plan.columns;
        let lines = row * plan.side * plan.width;
        let classes = self.classes.get(regions.clone()).unwrap_or_default();
        self.select_runs(frame, number, regions.clone());
        let is_still = self.scratch.runs.is_empty();
        if is_still && self.is_settled[row] {
            return;
        }
        // From the second still frame on, counts and actions repeat.
        self.is_settled[row] = is_still && plan.reference.is_stable_on_equal_frames();
        let reference = rows.start.min(self.reference.len())..rows.end.min(self.reference.len());
        if !is_still {
            let mut band = BandPass {
                plan,
                raw,
                number,
                denoised: &mut self.denoised[rows.clone()],
                reference: &self.reference[reference.clone()],
                classes,
            };
            band.compute_sums(self.scratch);
        }
        let mut results = self.results.range(regions.clone());
        let valid = &mut self.reference_valid[regions.clone()];
        let sums = (&self.scratch.region_sums, &self.scratch.flow_errors[..]);
        plan.decide_band(sums, &self.scratch.affected, valid, classes, &mut results);
        let means = row * plan.band_means()..(row + 1) * plan.band_means();
        let means = &mut self.means[means];
        if let Some(periphery) = &plan.periphery {
            let shown = &mut self.summary_shown[regions.clone()];
            let WorkingMemory { means: current_means, mean_differences, affected, .. } =
                &mut *self.scratch;
            let current_means =
                CurrentMeans { means: current_means, differences: mean_differences, affected };
            let mut sent = SentSummaries { is_shown: shown, means };
            let level = |region: usize| match &plan.zones {
                None => periphery.level,
                Some(zones) => zones.summary_level(classes[region], periphery.level),
            };
            periphery.send_summaries(level, current_means, &mut sent, &mut results);
        }
        let mut renderer = BandRenderer {
            screen: &mut self.screen[lines..],
            denoised: &self.denoised[rows],
            reference: &mut self.reference[reference],
            reference_valid: valid,
            black_regions: &mut self.black_regions[regions],
            means,
        };
        renderer.apply_actions(plan, raw, number, results.actions);
    }

    /// Chooses the runs of band `number`, which has these regions of the strip, that have to be
    /// computed.
    #[inline(always)]
    fn select_runs(&mut self, frame: usize, number: usize, regions: Range<usize>) {
        let (plan, scratch) = (self.plan, &mut *self.scratch);
        let displacements = cut_to_range(self.results.displacements, &regions);
        let must_compute = &mut self.must_compute[regions];
        match self.changes.changed_around(plan, frame, number) {
            Some(changed) => {
                change::mark_affected(plan, changed, &mut scratch.affected);
                scratch
                    .affected
                    .iter_mut()
                    .zip(&*must_compute)
                    .for_each(|(own, &must)| *own |= must);
                // The vote of `flow` ends if the region stands still.
                let moved = displacements.iter().map(|&last| last != Displacement::default());
                scratch.affected.iter_mut().zip(moved).for_each(|(own, moved)| *own |= moved);
                change::collect_runs(plan, &scratch.affected, &mut scratch.runs);
                let computed: usize = scratch.runs.iter().map(Range::len).sum();
                let skipped = scratch.affected.iter().filter(|affected| !**affected).count();
                self.skipped[frame] +=
                    SkippedWork { regions: skipped, blocks: plan.blocks - computed };
            }
            None => {
                scratch.affected.fill(true);
                scratch.runs.clear();
                scratch.runs.push(0..plan.blocks);
            }
        }
        must_compute.fill(false);
    }

    /// Copies a band of the screen to the kept screen while it is in the cache.
    #[inline(always)]
    fn keep_screen(&mut self, frame: usize, row: usize) {
        let plan = self.plan;
        if let Some(kept) = self.kept.get_mut(frame) {
            let regions = row * plan.columns..(row + 1) * plan.columns;
            let black = cut_to_range(kept.black, &regions);
            if !black.is_empty() {
                let top = row * plan.side * plan.width;
                let screen = (&self.screen[top..], &self.black_regions[regions]);
                keep_screen_band(
                    plan,
                    self.bands.start + row,
                    screen,
                    (&mut kept.screen[top..], black),
                );
            }
        }
    }
}
