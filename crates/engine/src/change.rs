// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for what has to be computed: a region that is bit-identical to the last frame
//! keeps its results. [`ChangeSearch`] compares frames before anything is computed, and
//! [`collect_runs`] chooses the blocks under the regions that may have other results
//! ([`mark_affected`]).

use crate::pixels::BorrowedFrame;
use crate::plan::CameraPlan;
use crate::policy::SearchStep;
use foveate_pixels::vectors::{BLOCK_LENGTH, VectorPixel, VectorTask};
use std::ops::Range;

/// The share of a band's blocks, as a fraction, above which the whole band is computed.
const WHOLE_BAND_SHARE: (usize, usize) = (4, 5);

/// Compares band `number` with its copy of the last frame, updates the copy, and sets `changed` for
/// every region in which a pixel differs.
#[inline(always)]
pub(crate) fn compare_and_update_copy<T: VectorPixel>(
    plan: &CameraPlan<T>,
    raw: BorrowedFrame<'_, T>,
    number: usize,
    copy: &mut [T],
    changed: &mut [bool],
) {
    changed.fill(false);
    let mut all_changed = false;
    for (y, last) in copy.chunks_exact_mut(plan.width).enumerate() {
        let current = raw.row(number * plan.side + y);
        if !all_changed {
            if current == last {
                continue;
            }
            compare_row(current, last, plan.side, changed);
            all_changed = changed.iter().all(|&changed| changed);
        }
        last.copy_from_slice(current);
    }
}

/// Compares band `number` of two frames, and sets `changed` for every region in which a pixel
/// differs.
#[inline(always)]
pub(crate) fn compare_frames<T: VectorPixel>(
    plan: &CameraPlan<T>,
    [last, current]: [BorrowedFrame<'_, T>; 2],
    number: usize,
    changed: &mut [bool],
) {
    changed.fill(false);
    let top = number * plan.side;
    for y in top..(top + plan.side).min(plan.height) {
        if current.row(y) == last.row(y) {
            continue;
        }
        compare_row(current.row(y), last.row(y), plan.side, changed);
        if changed.iter().all(|&changed| changed) {
            return;
        }
    }
}

/// Copies band `number`.
#[inline(always)]
pub(crate) fn copy_band<T: VectorPixel>(
    plan: &CameraPlan<T>,
    raw: BorrowedFrame<'_, T>,
    number: usize,
    copy: &mut [T],
) {
    for (y, copy) in copy.chunks_exact_mut(plan.width).enumerate() {
        copy.copy_from_slice(raw.row(number * plan.side + y));
    }
}

#[inline(always)]
fn compare_row<T: VectorPixel>(current: &[T], last: &[T], side: usize, changed: &mut [bool]) {
    match side {
        8 => compare_constant::<8, T>(current, last, changed),
        16 => compare_constant::<16, T>(current, last, changed),
        32 => compare_constant::<32, T>(current, last, changed),
        64 => compare_constant::<64, T>(current, last, changed),
        _ => compare_any(current, last, side, changed),
    }
}

#[inline(always)]
fn compare_constant<const SIDE: usize, T: VectorPixel>(
    current: &[T],
    last: &[T],
    changed: &mut [bool],
) {
    let ((current, current_rest), (last, last_rest)) =
        (current.as_chunks::<SIDE>(), last.as_chunks::<SIDE>());
    let (whole, ragged) = changed.split_at_mut(current.len());
    for ((current, last), changed) in current.iter().zip(last).zip(whole) {
        *changed |= current != last;
    }
    compare_any(current_rest, last_rest, SIDE, ragged);
}

#[inline(always)]
fn compare_any<T: VectorPixel>(current: &[T], last: &[T], side: usize, changed: &mut [bool]) {
    for ((current, last), changed) in current.chunks(side).zip(last.chunks(side)).zip(changed) {
        *changed |= current != last;
    }
}

/// Marks the regions of the middle one of three bands that may have other results than in the last
/// frame. These are the regions that have changed and, with shared neighborhoods, the regions
/// around them. One region on each side is enough, because the halo of two pixels is at most one
/// region wide.
#[inline(always)]
pub(crate) fn mark_affected<T: VectorPixel>(
    plan: &CameraPlan<T>,
    [above, here, below]: [&[bool]; 3],
    affected: &mut [bool],
) {
    if plan.seams.is_some() {
        affected.copy_from_slice(here);
        return;
    }
    let column = |x: usize| above[x] | here[x] | below[x];
    let last = plan.columns - 1;
    for (x, affected) in affected.iter_mut().enumerate().take(last).skip(1) {
        *affected = column(x - 1) | column(x) | column(x + 1);
    }
    affected[0] = column(0) | column(1.min(last));
    affected[last] = column(last.saturating_sub(1)) | column(last);
}

/// Collects the blocks under the affected regions as runs. Each run costs `margin` blocks more on
/// each side, so runs that lie closer together than that are merged. If nearly all blocks are
/// needed, one run covers the band.
#[inline(always)]
pub(crate) fn collect_runs<T: VectorPixel>(
    plan: &CameraPlan<T>,
    affected: &[bool],
    runs: &mut Vec<Range<usize>>,
) {
    runs.clear();
    let (side, margin) = (plan.side, plan.margin_blocks());
    for (column, _) in affected.iter().enumerate().filter(|(_, affected)| **affected) {
        let (start, end) =
            (column * side / BLOCK_LENGTH, ((column + 1) * side).div_ceil(BLOCK_LENGTH));
        match runs.last_mut() {
            Some(last) if start <= last.end + 2 * margin => last.end = end,
            _ => runs.push(start..end),
        }
    }
    let cost: usize = runs.iter().map(|run| run.len() + 2 * margin).sum();
    if cost * WHOLE_BAND_SHARE.1 > plan.blocks * WHOLE_BAND_SHARE.0 {
        runs.clear();
        runs.push(0..plan.blocks);
    }
}

/// A task that finds the changed regions in some bands of a batch of frames.
#[derive(Debug)]
pub(crate) struct ChangeSearch<'a, T: VectorPixel> {
    pub(crate) plan: &'a CameraPlan<T>,
    pub(crate) frames: &'a [BorrowedFrame<'a, T>],
    pub(crate) bands: Range<usize>,
    pub(crate) step: SearchStep,
    /// The part of the frame before the batch that belongs to the bands, without padding.
    pub(crate) last_frame: &'a mut [T],
    /// One flag per region and frame, in the order band, frame, column.
    pub(crate) changed_regions: &'a mut [bool],
}

impl<T: VectorPixel> VectorTask for ChangeSearch<'_, T> {
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

impl<T: VectorPixel> ChangeSearch<'_, T> {
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
                None => compare_and_update_copy(plan, frames[0], band, copy, changed),
                Some(last) => {
                    compare_frames(plan, [frames[last], frames[frame]], band, changed);
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
            copy_band(plan, last, band, copy);
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
    pub(crate) fn changed_around<T: VectorPixel>(
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

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_camera::{CameraConfig, Neighborhood};

    #[test]
    fn runs_cover_affected_regions_and_merge() {
        let runs_of = |width: u32, side: u32, neighborhood, columns: &[usize]| {
            let mut config = CameraConfig::default();
            (config.frame.width, config.frame.height) = (Some(width), Some(side));
            (config.region.size, config.region.neighborhood) = (side, neighborhood);
            let plan = CameraPlan::<u8>::new(&config.validate().unwrap());
            let affected: Vec<bool> = (0..plan.columns).map(|x| columns.contains(&x)).collect();
            let mut runs = Vec::new();
            collect_runs(&plan, &affected, &mut runs);
            runs
        };
        use Neighborhood::{Isolated, Shared};
        assert_eq!(runs_of(640, 8, Isolated, &[0, 7, 8, 24]), [0..2, 3..4]);
        assert_eq!(runs_of(1280, 8, Shared, &[0, 7, 8, 24, 56]), [0..4, 7..8]);
        // Region 10, which is 6 pixels wide, lies in two blocks.
        assert_eq!(runs_of(600, 6, Isolated, &[10]), vec![0..2]);
        // Nearly all blocks become all blocks, and no affected region gives no run.
        assert_eq!(runs_of(256, 8, Shared, &[0, 24]), vec![0..4]);
        assert_eq!(runs_of(640, 8, Shared, &[]), []);
    }
}
