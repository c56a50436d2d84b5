// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of frames that finds the regions that have changed, before anything is computed.

use std::ops::Range;

use crate::change;
use crate::pixels::Pixels;
use crate::plan::CameraPlan;
use crate::policy::Step;
use foveate_lanes::Lane;
use foveate_lanes::Task;

/// A task that finds the changed regions in some bands of a batch of frames.
#[derive(Debug)]
pub(crate) struct Look<'a, T: Lane> {
    pub(crate) plan: &'a CameraPlan<T>,
    pub(crate) frames: &'a [Pixels<'a, T>],
    pub(crate) bands: Range<usize>,
    pub(crate) step: Step,
    /// The part of the frame before the batch that belongs to the bands, without padding.
    pub(crate) copy: &'a mut [T],
    /// One flag per region and frame, in the order band, frame, column.
    pub(crate) changed: &'a mut [bool],
}

impl<T: Lane> Task for Look<'_, T> {
    #[inline(always)]
    fn run(mut self) {
        let plan = self.plan;
        let rows = plan.side * plan.width;
        let copies = std::mem::take(&mut self.copy).chunks_mut(rows);
        let changed = std::mem::take(&mut self.changed);
        let changed = changed.chunks_exact_mut(plan.columns * self.frames.len());
        for ((band, copy), changed) in self.bands.clone().zip(copies).zip(changed) {
            if self.step.concerns(band) {
                self.band(band, copy, changed);
            }
        }
    }
}

impl<T: Lane> Look<'_, T> {
    #[inline(always)]
    fn band(&self, band: usize, copy: &mut [T], changed: &mut [bool]) {
        let (plan, frames) = (self.plan, self.frames);
        let compared = match self.step {
            Step::Rest | Step::Sample => 0..0,
            Step::Judge(frame) => frame..frame + 1,
            Step::Keep => 1..frames.len(),
            Step::Compare => 0..frames.len(),
        };
        for (frame, changed) in changed.chunks_exact_mut(plan.columns).enumerate() {
            if !compared.contains(&frame) {
                continue;
            }
            match frame.checked_sub(1) {
                None => change::compare(plan, frames[0], band, copy, changed),
                Some(last) => {
                    change::compare_frames(plan, [frames[last], frames[frame]], band, changed);
                }
            }
        }
        let kept = match self.step {
            Step::Rest | Step::Judge(_) => false,
            Step::Sample | Step::Keep => true,
            // A comparison with the copy brings it up to date.
            Step::Compare => frames.len() > 1,
        };
        if let (true, Some(&last)) = (kept, frames.last()) {
            change::keep(plan, last, band, copy);
        }
    }
}

/// The known changes of a batch.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Changes<'a> {
    /// One flag per region and frame, in the order band, frame, column.
    pub(crate) changed: &'a [bool],
    /// The number of frames in the batch.
    pub(crate) frames: usize,
    /// The first frame whose changes are known. It is the number of frames if no changes are known.
    pub(crate) first: usize,
}

impl<'a> Changes<'a> {
    /// Returns the changed regions of a frame's band and of the bands above and below it, if they
    /// are known.
    #[inline(always)]
    pub(crate) fn around<T: Lane>(
        &self,
        plan: &CameraPlan<T>,
        frame: usize,
        band: usize,
    ) -> Option<[&'a [bool]; 3]> {
        let of = |band: usize| {
            &self.changed[(band * self.frames + frame) * plan.columns..][..plan.columns]
        };
        let below = (band + 1).min(plan.rows - 1);
        (frame >= self.first).then(|| [of(band.saturating_sub(1)), of(band), of(below)])
    }
}
