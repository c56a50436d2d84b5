// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of frames that finds the regions that have changed, before anything is computed.

use std::ops::Range;

use crate::change;
use crate::pixels::BorrowedFrame;
use crate::plan::CameraPlan;
use crate::policy::SearchStep;
use foveate_pixels::{lanes::PixelLane, lanes::VectorTask};

/// A task that finds the changed regions in some bands of a batch of frames.
#[derive(Debug)]
pub(crate) struct ChangeSearch<'a, T: PixelLane> {
    pub(crate) plan: &'a CameraPlan<T>,
    pub(crate) frames: &'a [BorrowedFrame<'a, T>],
    pub(crate) bands: Range<usize>,
    pub(crate) step: SearchStep,
    /// The part of the frame before the batch that belongs to the bands, without padding.
    pub(crate) last_frame: &'a mut [T],
    /// One flag per region and frame, in the order band, frame, column.
    pub(crate) changed_regions: &'a mut [bool],
}

impl<T: PixelLane> VectorTask for ChangeSearch<'_, T> {
    #[inline(always)]
    fn run(mut self) {
        let plan = self.plan;
        let rows = plan.side * plan.width;
        let copies = std::mem::take(&mut self.last_frame).chunks_mut(rows);
        let changed = std::mem::take(&mut self.changed_regions);
        let changed = changed.chunks_exact_mut(plan.columns * self.frames.len());
        for ((band, copy), changed) in self.bands.clone().zip(copies).zip(changed) {
            if self.step.includes_band(band) {
                self.search_band(band, copy, changed);
            }
        }
    }
}

impl<T: PixelLane> ChangeSearch<'_, T> {
    #[inline(always)]
    fn search_band(&self, band: usize, copy: &mut [T], changed: &mut [bool]) {
        let (plan, frames) = (self.plan, self.frames);
        let compared = match self.step {
            SearchStep::Rest | SearchStep::CopySample => 0..0,
            SearchStep::CompareSample(frame) => frame..frame + 1,
            SearchStep::CompareWithinBatch => 1..frames.len(),
            SearchStep::CompareAll => 0..frames.len(),
        };
        for (frame, changed) in changed.chunks_exact_mut(plan.columns).enumerate() {
            if !compared.contains(&frame) {
                continue;
            }
            match frame.checked_sub(1) {
                None => change::compare_and_update_copy(plan, frames[0], band, copy, changed),
                Some(last) => {
                    change::compare_frames(plan, [frames[last], frames[frame]], band, changed);
                }
            }
        }
        let updates_copy = match self.step {
            SearchStep::Rest | SearchStep::CompareSample(_) => false,
            SearchStep::CopySample | SearchStep::CompareWithinBatch => true,
            // A comparison with the copy brings it up to date.
            SearchStep::CompareAll => frames.len() > 1,
        };
        if let (true, Some(&last)) = (updates_copy, frames.last()) {
            change::copy_band(plan, last, band, copy);
        }
    }
}

/// The known changes of a batch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KnownChanges<'a> {
    /// One flag per region and frame, in the order band, frame, column.
    pub(crate) changed: &'a [bool],
    /// The number of frames in the batch.
    pub(crate) frames: usize,
    /// The first frame whose changes are known. It is the number of frames if no changes are known.
    pub(crate) first_known: usize,
}

impl<'a> KnownChanges<'a> {
    /// Returns the changed regions of a frame's band and of the bands above and below it, if they
    /// are known.
    #[inline(always)]
    pub(crate) fn changed_around<T: PixelLane>(
        &self,
        plan: &CameraPlan<T>,
        frame: usize,
        band: usize,
    ) -> Option<[&'a [bool]; 3]> {
        let flags_of = |band: usize| {
            &self.changed[(band * self.frames + frame) * plan.columns..][..plan.columns]
        };
        let below = (band + 1).min(plan.rows - 1);
        (frame >= self.first_known)
            .then(|| [flags_of(band.saturating_sub(1)), flags_of(band), flags_of(below)])
    }
}
