// SPDX-License-Identifier: MIT OR Apache-2.0
//! One pass over the rows of a band while all of it is in the cache: denoise, compare, score.

use std::ops::Range;

use foveate_camera::Reference;

use crate::denoised::Denoiser;
use crate::kernel::{Open, Sides, Windows, corner, edge, mad, sums, temporal};
use crate::periphery::PeripheryPlan;
use crate::pixels::Pixels;
use crate::plan::{CameraPlan, Passes};
use crate::scratch::{Columns, Scratch, Sums};
use foveate_lanes::{BLOCK, Block, Lane, threshold};

/// Returns the blocks of a run in row `y` of a padded plane.
#[inline(always)]
fn blocks<'a, T>(plane: &'a [T], stride: usize, y: usize, run: &Range<usize>) -> &'a [Block<T>] {
    plane[y * stride + run.start * BLOCK..][..run.len() * BLOCK].as_chunks().0
}

/// Returns the blocks of a run in row `y` of a padded plane, to be written.
#[inline(always)]
fn blocks_mut<'a, T>(
    plane: &'a mut [T],
    stride: usize,
    y: usize,
    run: &Range<usize>,
) -> &'a mut [Block<T>] {
    plane[y * stride + run.start * BLOCK..][..run.len() * BLOCK].as_chunks_mut().0
}

/// Counts the hits of the features that use windows in one row.
#[inline(always)]
fn features<T: Lane>(
    plan: &CameraPlan<T>,
    windows: Windows<'_, T>,
    sides: impl Sides<T>,
    columns: &mut Columns<T>,
    run: &Range<usize>,
) {
    if let Some(half) = plan.passes.edge {
        edge::count(windows, sides, half, &mut columns.edge.blocks_mut()[run.clone()]);
    }
    if let Some(level) = plan.passes.corner {
        corner::count(windows, sides, level, &mut columns.corner.blocks_mut()[run.clone()]);
    }
}

/// A band of regions with its part of the planes.
#[derive(Debug)]
pub(crate) struct Band<'a, T: Lane> {
    pub(crate) plan: &'a CameraPlan<T>,
    pub(crate) raw: Pixels<'a, T>,
    /// The number of the band, counted from the top.
    pub(crate) number: usize,
    /// The denoised pixels of the last frame, which the pass replaces by those of this frame. They
    /// are the reference of `previous`.
    pub(crate) denoised: &'a mut [T],
    /// The reference of `last-sent`, otherwise empty.
    pub(crate) reference: &'a [T],
}

impl<T: Lane> Band<'_, T> {
    /// Fills `scratch.sums` for every region that the runs cover.
    #[inline(always)]
    pub(crate) fn measure<const PERIPHERY: bool>(&mut self, scratch: &mut Scratch<T>) {
        let runs = std::mem::take(&mut scratch.runs);
        for run in &runs {
            self.first_pass(scratch, run);
        }
        self.columns_to_regions(&scratch.columns, &mut scratch.sums);
        if let Some(fraction_bits) = self.plan.passes.mad {
            self.spread_means(scratch, fraction_bits);
            for run in &runs {
                self.second_pass(&mut scratch.columns, run, fraction_bits);
            }
            let side = self.plan.side;
            sums::by_region(&scratch.columns.above, side, &mut scratch.sums.above);
            if fraction_bits > 0 {
                sums::by_region(&scratch.columns.over, side, &mut scratch.sums.over);
            }
        }
        if PERIPHERY && let Some(periphery) = self.plan.periphery {
            for run in &runs {
                self.means_of_blocks(periphery, scratch, run);
            }
        }
        scratch.runs = runs;
    }

    /// Computes the means of the blocks of every region that a run covers, from the pixels of the
    /// payload.
    #[inline(always)]
    fn means_of_blocks(
        &self,
        periphery: PeripheryPlan<T>,
        scratch: &mut Scratch<T>,
        run: &Range<usize>,
    ) {
        let (plan, stride) = (self.plan, self.plan.stride());
        let Scratch { columns, means, raw, .. } = scratch;
        let covered = plan.blocks_under(periphery.side, run);
        for (row, means) in means.chunks_exact_mut(plan.means_in_row()).enumerate() {
            let own = &mut columns.sum.blocks_mut()[run.clone()];
            let rows = row * periphery.side..(row + 1) * periphery.side;
            if plan.keeps_raw {
                own.fill([T::Sum::default(); BLOCK]);
                for y in rows {
                    let pixels = self.raw.row(self.number * plan.side + y);
                    raw.values_mut()[..plan.width].copy_from_slice(pixels);
                    raw.repeat_border(plan.width, plan.padded_width());
                    sums::add(raw.blocks(run), own);
                }
            } else {
                sums::add_rows(&self.denoised[run.start * BLOCK..], stride, rows, own);
            }
            let columns = &columns.sum[covered.start * periphery.side..];
            periphery.means(columns, &mut means[covered.clone()]);
        }
    }

    #[inline(always)]
    fn first_pass(&mut self, scratch: &mut Scratch<T>, run: &Range<usize>) {
        let plan = self.plan;
        let Scratch { sorted, tail, denoised, columns, .. } = scratch;
        let top = self.number * plan.side;
        let mut denoiser = Denoiser {
            plan,
            raw: self.raw,
            sorted,
            tail,
            rows: denoised,
            slots: plan.slots(run.len()),
            reach: plan.reach(self.number),
            run: run.clone(),
        };
        columns.clear(plan, run);
        let batch = plan.batch(run.len());
        for first in (0..plan.side).step_by(batch) {
            let rows = first..(first + batch).min(plan.side);
            let [above, ..] = denoiser.around(top + rows.start);
            let [.., below] = denoiser.around(top + rows.end - 1);
            if plan.passes.has_windows {
                denoiser.ensure(above..below + 1);
                for y in top + rows.start..top + rows.end {
                    let windows = denoiser.windows(y);
                    match &plan.seams {
                        None => features(plan, windows, Open, columns, run),
                        Some(seams) => features(plan, windows, seams.over(run), columns, run),
                    }
                }
            } else {
                denoiser.ensure(top + rows.start..top + rows.end);
            }
            for row in rows {
                self.compare(denoiser.row(top + row), row, columns, run);
            }
        }
    }

    /// Compares a row with its reference, stores it, and adds it to the column sums.
    #[inline(always)]
    fn compare(
        &mut self,
        now: &[Block<T>],
        row: usize,
        columns: &mut Columns<T>,
        run: &Range<usize>,
    ) {
        let (plan, stride) = (self.plan, self.plan.stride());
        let changed = &mut columns.changed.blocks_mut()[run.clone()];
        let store = blocks_mut(self.denoised, stride, row, run);
        match plan.reference {
            Reference::Previous => temporal::count_and_replace(now, store, plan.level, changed),
            Reference::LastSent => {
                let reference = blocks(self.reference, stride, row, run);
                temporal::count_and_store(now, reference, plan.level, changed, store);
            }
        }
        if plan.passes.sums {
            sums::add(now, &mut columns.sum.blocks_mut()[run.clone()]);
        }
        if plan.passes.squares {
            sums::add_squares(now, &mut columns.square.blocks_mut()[run.clone()]);
        }
    }

    #[inline(always)]
    fn columns_to_regions(&self, columns: &Columns<T>, regions: &mut Sums) {
        let side = self.plan.side;
        // The pattern names every field, so that a new one is not forgotten. The sums of `mad`
        // follow in a second pass.
        let Passes { edge, corner, has_windows: _, sums, squares, mad: _ } = self.plan.passes;
        sums::by_region(&columns.changed, side, &mut regions.changed);
        if edge.is_some() {
            sums::by_region(&columns.edge, side, &mut regions.edge);
        }
        if corner.is_some() {
            sums::by_region(&columns.corner, side, &mut regions.corner);
        }
        if sums {
            sums::by_region(&columns.sum, side, &mut regions.sum);
        }
        if squares {
            sums::by_region(&columns.square, side, &mut regions.square);
        }
    }

    /// Writes the whole part of each region's mean into its columns.
    #[inline(always)]
    fn spread_means(&self, scratch: &mut Scratch<T>, fraction_bits: u32) {
        let n = u64::from(self.plan.region_pixels());
        let mean = |sum| {
            let mean = mad::mean(sum, n, fraction_bits) >> fraction_bits;
            threshold(u32::try_from(mean).expect("a mean is within the range of pixels"))
        };
        sums::spread(&scratch.sums.sum, self.plan.side, mean, &mut scratch.columns.mean);
    }

    #[inline(always)]
    fn second_pass(&self, columns: &mut Columns<T>, run: &Range<usize>, fraction_bits: u32) {
        let stride = self.plan.stride();
        let above = &mut columns.above.blocks_mut()[run.clone()];
        let over = &mut columns.over.blocks_mut()[run.clone()];
        let mean = &columns.mean.blocks()[run.clone()];
        above.fill([T::Sum::default(); BLOCK]);
        if fraction_bits > 0 {
            over.fill([T::default(); BLOCK]);
        }
        for row in 0..self.plan.side {
            let now = blocks(self.denoised, stride, row, run);
            mad::add_above(now, mean, above);
            if fraction_bits > 0 {
                mad::count_above(now, mean, over);
            }
        }
    }
}

impl<T: Lane> Columns<T> {
    /// Sets every sum that the first pass of a run uses to zero.
    #[inline(always)]
    fn clear(&mut self, plan: &CameraPlan<T>, run: &Range<usize>) {
        let Passes { edge, corner, has_windows: _, sums, squares, mad: _ } = plan.passes;
        self.changed.blocks_mut()[run.clone()].fill([T::default(); BLOCK]);
        if edge.is_some() {
            self.edge.blocks_mut()[run.clone()].fill([T::default(); BLOCK]);
        }
        if corner.is_some() {
            self.corner.blocks_mut()[run.clone()].fill([T::default(); BLOCK]);
        }
        if sums {
            self.sum.blocks_mut()[run.clone()].fill([T::Sum::default(); BLOCK]);
        }
        if squares {
            self.square.blocks_mut()[run.clone()].fill([T::Square::default(); BLOCK]);
        }
    }
}
