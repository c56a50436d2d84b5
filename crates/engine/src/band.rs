// SPDX-License-Identifier: MIT OR Apache-2.0
//! One pass over the rows of a band while all of it is in the cache: denoise, compare, score.

use std::ops::Range;

use foveate_camera::{ReferencePolicy, RegionClass};

use super::periphery::{BlockLevels, UniformLevel};
use crate::denoised::Denoiser;
use crate::feature_passes::FeaturePasses;
use crate::kernel::flow::DisplacedErrors;
use crate::kernel::segment::SegmentPlan;
use crate::kernel::{
    SharedSides, WindowRows, WindowSides, corner, edge, flow, mad, range, segment, sums, surface,
    temporal,
};
use crate::periphery::PeripheryPlan;
use crate::pixels::BorrowedFrame;
use crate::plan::CameraPlan;
use crate::vector_levels::VectorLevels;
use crate::working_memory::{ColumnSums, RegionSums, WorkingMemory};
use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel, saturated_threshold};

/// Returns the blocks of a run in row `y` of a padded plane.
#[inline(always)]
fn row_blocks<'a, T>(
    plane: &'a [T],
    stride: usize,
    y: usize,
    run: &Range<usize>,
) -> &'a [Block<T>] {
    plane[y * stride + run.start * BLOCK_LENGTH..][..run.len() * BLOCK_LENGTH].as_chunks().0
}

/// Returns the blocks of a run in row `y` of a padded plane, to be written.
#[inline(always)]
fn row_blocks_mut<'a, T>(
    plane: &'a mut [T],
    stride: usize,
    y: usize,
    run: &Range<usize>,
) -> &'a mut [Block<T>] {
    plane[y * stride + run.start * BLOCK_LENGTH..][..run.len() * BLOCK_LENGTH].as_chunks_mut().0
}

/// Adds one row to the values of the features that use windows.
#[inline(always)]
fn add_window_features<T: VectorPixel>(
    plan: &CameraPlan<T>,
    windows: WindowRows<'_, T>,
    sides: impl WindowSides<T>,
    levels: Option<&VectorLevels<T>>,
    columns: &mut ColumnSums<T>,
    run: &Range<usize>,
) {
    if let Some(half) = plan.passes.edge {
        let hits = &mut columns.edge.blocks_mut()[run.clone()];
        match levels {
            None => edge::count_edges(windows, sides, UniformLevel(half), hits),
            Some(levels) => {
                edge::count_edges(windows, sides, &levels.edge.blocks()[run.clone()], hits);
            }
        }
    }
    if let Some(level) = plan.passes.corner {
        let hits = &mut columns.corner.blocks_mut()[run.clone()];
        match levels {
            None => corner::count_corners(windows, sides, UniformLevel(level), hits),
            Some(levels) => {
                corner::count_corners(windows, sides, &levels.corner.blocks()[run.clone()], hits);
            }
        }
    }
    if plan.passes.needs_differences {
        let sums = columns.differences.each_mut();
        let sums = sums.map(|sums| &mut sums.blocks_mut()[run.clone()]);
        surface::add_differences(windows, sides, sums);
    }
}

/// A band of regions with its part of the planes.
#[derive(Debug)]
pub(crate) struct BandPass<'a, T: VectorPixel> {
    pub(crate) plan: &'a CameraPlan<T>,
    pub(crate) raw: BorrowedFrame<'a, T>,
    /// The number of the band, counted from the top.
    pub(crate) number: usize,
    /// The denoised pixels of the last frame, which the pass replaces by those of this frame. They
    /// are the reference of `previous`.
    pub(crate) denoised: &'a mut [T],
    /// The reference of `last-sent`, otherwise empty.
    pub(crate) reference: &'a [T],
    /// The classes of the band's regions.
    pub(crate) classes: &'a [RegionClass],
}

impl<T: VectorPixel> BandPass<'_, T> {
    /// Fills `scratch.sums` for every region that the runs cover.
    #[inline(always)]
    pub(crate) fn compute_sums(&mut self, scratch: &mut WorkingMemory<T>) {
        let runs = std::mem::take(&mut scratch.runs);
        scratch.levels.set(self.plan, self.classes);
        for run in &runs {
            // The first pass replaces the reference of `previous`.
            self.copy_references(scratch, run);
            self.first_pass(scratch, run);
        }
        self.sum_displaced(scratch, &runs);
        if self.plan.passes.needs_sums {
            // The second passes of `mad` and `segment` need the means.
            let sums = &mut scratch.region_sums.sum;
            sums::sum_by_region(&scratch.columns.sum, self.plan.side, sums);
        }
        if let Some(fraction_bits) = self.plan.passes.mad {
            self.sum_deviations(scratch, &runs, fraction_bits);
        }
        if let Some(segment) = self.plan.passes.segment {
            self.count_parts(scratch, &runs, segment);
        }
        self.columns_to_regions(&scratch.columns, &mut scratch.region_sums);
        if let Some(periphery) = self.plan.periphery {
            for run in &runs {
                self.means_of_blocks(periphery, scratch, run);
            }
        }
        scratch.runs = runs;
    }

    /// Copies the references of a run for the search of `flow`, if there is one.
    #[inline(always)]
    fn copy_references(&self, scratch: &mut WorkingMemory<T>, run: &Range<usize>) {
        let plane: &[T] = match self.plan.reference {
            ReferencePolicy::Previous => self.denoised,
            ReferencePolicy::LastSent => self.reference,
        };
        for (row, copy) in scratch.references.iter_mut().enumerate() {
            let blocks = row_blocks(plane, self.plan.stride(), row, run);
            copy.blocks_mut(run).copy_from_slice(blocks);
        }
    }

    /// Sums the differences from the displaced references, for `flow`. Pixels at the ends of a run
    /// may be compared with the reference of another region; such pairs are not added to a region.
    #[inline(always)]
    fn sum_displaced(&self, scratch: &mut WorkingMemory<T>, runs: &[Range<usize>]) {
        let (side, stride) = (self.plan.side, self.plan.stride());
        let WorkingMemory { references, flow_errors, flow_columns, .. } = scratch;
        for DisplacedErrors { displacement, errors, .. } in flow_errors {
            let rows = flow::paired_range(side, displacement.dy);
            let partners = flow::paired_range(side, -displacement.dy);
            for run in runs {
                let sums = &mut flow_columns.blocks_mut()[run.clone()];
                sums.fill([T::ColumnSum::default(); BLOCK_LENGTH]);
                for (row, partner) in rows.clone().zip(partners.clone()) {
                    let current = row_blocks(self.denoised, stride, row, run);
                    let partners = references[partner].shifted_blocks(run, displacement.dx);
                    flow::add_differences::<T>(current, partners, sums);
                }
            }
            flow::sum_paired_columns(flow_columns, side, displacement.dx, errors);
        }
    }

    /// Computes the means of the blocks of every region that a run covers, from the pixels of the
    /// payload.
    #[inline(always)]
    fn means_of_blocks(
        &self,
        periphery: PeripheryPlan<T>,
        scratch: &mut WorkingMemory<T>,
        run: &Range<usize>,
    ) {
        let (plan, stride) = (self.plan, self.plan.stride());
        let WorkingMemory { columns, means, raw, .. } = scratch;
        let covered = plan.blocks_under(periphery.side, run);
        for (row, means) in means.chunks_exact_mut(plan.means_in_row()).enumerate() {
            let block_sums = &mut columns.sum.blocks_mut()[run.clone()];
            let rows = row * periphery.side..(row + 1) * periphery.side;
            if plan.keeps_raw {
                block_sums.fill([T::ColumnSum::default(); BLOCK_LENGTH]);
                for y in rows {
                    let pixels = self.raw.row(self.number * plan.side + y);
                    raw.values_mut()[..plan.width].copy_from_slice(pixels);
                    raw.repeat_border(plan.width, plan.padded_width());
                    sums::add_to_columns(raw.blocks(run), block_sums);
                }
            } else {
                sums::add_rows(
                    &self.denoised[run.start * BLOCK_LENGTH..],
                    stride,
                    rows,
                    block_sums,
                );
            }
            let columns = &columns.sum[covered.start * periphery.side..];
            periphery.compute_means(columns, &mut means[covered.clone()]);
        }
    }

    #[inline(always)]
    fn first_pass(&mut self, scratch: &mut WorkingMemory<T>, run: &Range<usize>) {
        let plan = self.plan;
        let WorkingMemory {
            sorted,
            column_sums,
            narrow_window: tail,
            denoised,
            columns,
            levels,
            ..
        } = scratch;
        let levels = levels.in_use();
        let top = self.number * plan.side;
        let mut denoiser = Denoiser {
            plan,
            raw: self.raw,
            sorted,
            column_sums,
            tail,
            rows: denoised,
            slots: plan.row_slots(run.len()),
            reachable_rows: plan.reachable_rows(self.number),
            run: run.clone(),
        };
        columns.clear(plan, run);
        let batch = plan.batch_rows(run.len());
        for first in (0..plan.side).step_by(batch) {
            let rows = first..(first + batch).min(plan.side);
            let [above, ..] = denoiser.window_rows(top + rows.start);
            let [.., below] = denoiser.window_rows(top + rows.end - 1);
            denoiser.ensure_rows(if plan.passes.has_windows {
                above..below + 1
            } else {
                top + rows.start..top + rows.end
            });
            if plan.passes.has_windows {
                for y in top + rows.start..top + rows.end {
                    let windows = denoiser.windows(y);
                    match &plan.seams {
                        None => {
                            add_window_features(plan, windows, SharedSides, levels, columns, run);
                        }
                        Some(seams) => {
                            let sides = seams.masks_of(run);
                            add_window_features(plan, windows, sides, levels, columns, run);
                        }
                    }
                }
            }
            for row in rows {
                self.take_row(denoiser.row(top + row), row, levels, columns, run);
            }
        }
    }

    /// Compares a row with its reference, stores it, and adds it to the values of the columns.
    #[inline(always)]
    fn take_row(
        &mut self,
        current: &[Block<T>],
        row: usize,
        levels: Option<&VectorLevels<T>>,
        columns: &mut ColumnSums<T>,
        run: &Range<usize>,
    ) {
        let plan = self.plan;
        let changed = &mut columns.changed.blocks_mut()[run.clone()];
        match levels {
            None => self.compare_row(current, row, UniformLevel(plan.level), changed, run),
            Some(levels) => {
                let levels = &levels.temporal.blocks()[run.clone()];
                self.compare_row(current, row, levels, changed, run);
            }
        }
        if plan.passes.needs_sums {
            sums::add_to_columns(current, &mut columns.sum.blocks_mut()[run.clone()]);
        }
        if plan.passes.needs_squares {
            sums::add_squares(current, &mut columns.square.blocks_mut()[run.clone()]);
        }
        if plan.passes.needs_extremes {
            range::update_extremes(
                current,
                &mut columns.smallest.blocks_mut()[run.clone()],
                &mut columns.largest.blocks_mut()[run.clone()],
            );
        }
    }

    /// Counts the changed pixels of a row, and stores the row.
    #[inline(always)]
    fn compare_row(
        &mut self,
        current: &[Block<T>],
        row: usize,
        levels: impl BlockLevels<T>,
        changed: &mut [Block<T>],
        run: &Range<usize>,
    ) {
        let stride = self.plan.stride();
        let stored = row_blocks_mut(self.denoised, stride, row, run);
        match self.plan.reference {
            ReferencePolicy::Previous => {
                temporal::count_and_replace(current, stored, levels, changed);
            }
            ReferencePolicy::LastSent => {
                let reference = row_blocks(self.reference, stride, row, run);
                temporal::count_and_store(current, reference, levels, changed, stored);
            }
        }
    }

    /// Adds up the columns of every region. Columns of one type share a loop, because each call of
    /// `sum_by_region` is compiled for every region size and instruction set.
    #[inline(always)]
    fn columns_to_regions(&self, columns: &ColumnSums<T>, regions: &mut RegionSums) {
        let side = self.plan.side;
        // The pattern names every field, so that a new one is not forgotten.
        let FeaturePasses {
            edge,
            corner,
            has_windows: _,
            needs_sums: _,
            needs_squares: squares,
            needs_extremes: extremes,
            needs_differences: differences,
            mad,
            segment,
        } = self.plan.passes;
        let [upper, lower] = &columns.segment;
        let [regions_upper, regions_lower] = &mut regions.segment;
        let counts = [
            (true, &columns.changed, &mut regions.changed),
            (edge.is_some(), &columns.edge, &mut regions.edge),
            (corner.is_some(), &columns.corner, &mut regions.corner),
            (mad > Some(0), &columns.count_above, &mut regions.count_above),
            (segment.is_some(), upper, regions_upper),
            (segment.is_some(), lower, regions_lower),
        ];
        for (is_used, columns, regions) in counts {
            if is_used {
                sums::sum_by_region(columns, side, regions);
            }
        }
        let above = (mad.is_some(), &columns.above, &mut regions.above);
        let displaced = columns.differences.iter().zip(&mut regions.differences);
        let displaced = displaced.map(|(columns, regions)| (differences, columns, regions));
        for (is_used, columns, regions) in displaced.chain([above]) {
            if is_used {
                sums::sum_by_region(columns, side, regions);
            }
        }
        if squares {
            sums::sum_by_region(&columns.square, side, &mut regions.square);
        }
        if extremes {
            range::ranges_by_region(&columns.smallest, &columns.largest, side, &mut regions.range);
        }
    }

    /// Sums the amounts by which pixels exceed the mean of their region, for `mad`.
    #[inline(always)]
    fn sum_deviations(
        &self,
        scratch: &mut WorkingMemory<T>,
        runs: &[Range<usize>],
        fraction_bits: u32,
    ) {
        self.spread_means(scratch, fraction_bits);
        for run in runs {
            self.sum_deviations_of_run(&mut scratch.columns, run, fraction_bits);
        }
    }

    /// Counts the pixels above and below the bounds of their region, for `segment`.
    #[inline(always)]
    fn count_parts(
        &self,
        scratch: &mut WorkingMemory<T>,
        runs: &[Range<usize>],
        segment: SegmentPlan,
    ) {
        let WorkingMemory { columns, region_sums, .. } = scratch;
        let (side, n) = (self.plan.side, u64::from(self.plan.region_pixels()));
        let element = |bound: u64| {
            saturated_threshold(u32::try_from(bound).expect("a bound is below twice the pixels"))
        };
        let [upper, lower] = &mut columns.segment_bounds;
        let sums = &region_sums.sum;
        let keen = self.plan.zones.as_ref().and_then(|zones| zones.keen_passes.segment);
        let of_region = |region: usize| match (keen, self.classes.get(region)) {
            (Some(keen), Some(RegionClass::Keen)) => keen,
            _ => segment,
        };
        let bound = |region, sum| element(of_region(region).upper_bound(sum, n));
        sums::spread_over_columns(sums, side, bound, upper);
        let bound = |region, sum| element(of_region(region).lower_bound(sum, n));
        sums::spread_over_columns(sums, side, bound, lower);
        for run in runs {
            let bounds = columns.segment_bounds.each_ref();
            let bounds = bounds.map(|bound| &bound.blocks()[run.clone()]);
            for counts in &mut columns.segment {
                counts.blocks_mut()[run.clone()].fill([T::default(); BLOCK_LENGTH]);
            }
            for row in 0..side {
                let current = row_blocks(self.denoised, self.plan.stride(), row, run);
                let counts = columns.segment.each_mut();
                let counts = counts.map(|counts| &mut counts.blocks_mut()[run.clone()]);
                segment::count_parts(current, bounds, counts);
            }
        }
    }

    /// Writes the whole part of each region's mean into its columns.
    #[inline(always)]
    fn spread_means(&self, scratch: &mut WorkingMemory<T>, fraction_bits: u32) {
        let n = u64::from(self.plan.region_pixels());
        let mean = |_, sum| {
            let mean = mad::region_mean(sum, n, fraction_bits) >> fraction_bits;
            saturated_threshold(u32::try_from(mean).expect("a mean is within the range of pixels"))
        };
        sums::spread_over_columns(
            &scratch.region_sums.sum,
            self.plan.side,
            mean,
            &mut scratch.columns.mean,
        );
    }

    #[inline(always)]
    fn sum_deviations_of_run(
        &self,
        columns: &mut ColumnSums<T>,
        run: &Range<usize>,
        fraction_bits: u32,
    ) {
        let stride = self.plan.stride();
        let above = &mut columns.above.blocks_mut()[run.clone()];
        let count_above = &mut columns.count_above.blocks_mut()[run.clone()];
        let mean = &columns.mean.blocks()[run.clone()];
        above.fill([T::ColumnSum::default(); BLOCK_LENGTH]);
        if fraction_bits > 0 {
            count_above.fill([T::default(); BLOCK_LENGTH]);
        }
        for row in 0..self.plan.side {
            let current = row_blocks(self.denoised, stride, row, run);
            mad::add_above(current, mean, above);
            if fraction_bits > 0 {
                mad::count_above(current, mean, count_above);
            }
        }
    }
}

impl<T: VectorPixel> ColumnSums<T> {
    /// Sets every sum that the first pass of a run uses to zero.
    #[inline(always)]
    fn clear(&mut self, plan: &CameraPlan<T>, run: &Range<usize>) {
        let FeaturePasses {
            edge,
            corner,
            has_windows: _,
            needs_sums: sums,
            needs_squares: squares,
            needs_extremes: extremes,
            needs_differences: differences,
            mad: _,
            segment: _,
        } = plan.passes;
        self.changed.blocks_mut()[run.clone()].fill([T::default(); BLOCK_LENGTH]);
        if edge.is_some() {
            self.edge.blocks_mut()[run.clone()].fill([T::default(); BLOCK_LENGTH]);
        }
        if corner.is_some() {
            self.corner.blocks_mut()[run.clone()].fill([T::default(); BLOCK_LENGTH]);
        }
        if sums {
            self.sum.blocks_mut()[run.clone()].fill([T::ColumnSum::default(); BLOCK_LENGTH]);
        }
        if squares {
            self.square.blocks_mut()[run.clone()].fill([T::SquareSum::default(); BLOCK_LENGTH]);
        }
        if extremes {
            self.smallest.blocks_mut()[run.clone()].fill([T::MAX; BLOCK_LENGTH]);
            self.largest.blocks_mut()[run.clone()].fill([T::default(); BLOCK_LENGTH]);
        }
        if differences {
            for sums in &mut self.differences {
                sums.blocks_mut()[run.clone()].fill([T::ColumnSum::default(); BLOCK_LENGTH]);
            }
        }
    }
}
