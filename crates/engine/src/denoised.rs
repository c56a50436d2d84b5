// SPDX-License-Identifier: MIT OR Apache-2.0
//! Denoised rows, computed on demand. The rows around a batch are kept, so that each row is
//! computed once although several windows use it.

use std::ops::Range;

use foveate_camera::DenoiseFilter;

use crate::kernel::{IsolatedSides, SharedSides, WindowRows, binomial, median, switching};
use crate::pixels::BorrowedFrame;
use crate::plan::{CameraPlan, SeamMasks};
use crate::working_memory::{BlockRow, DenoisedRow};
use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

impl<T: VectorPixel> SeamMasks<T> {
    /// Returns the masks of some blocks.
    #[inline(always)]
    pub(crate) fn masks_of(&self, span: &Range<usize>) -> IsolatedSides<'_, T> {
        IsolatedSides {
            first: &self.first.blocks()[span.clone()],
            last: &self.last.blocks()[span.clone()],
        }
    }
}

/// The number of rows between the row that is sorted and the row that is prefetched.
const PREFETCH_ROWS: usize = 6;

/// The denoised rows of one run of blocks, with the padding and the borders that the contract
/// defines.
#[derive(Debug)]
pub(crate) struct Denoiser<'a, T: VectorPixel> {
    pub(crate) plan: &'a CameraPlan<T>,
    pub(crate) raw: BorrowedFrame<'a, T>,
    pub(crate) sorted: &'a mut [[BlockRow<T>; 3]],
    pub(crate) column_sums: &'a mut [BlockRow<T::ColumnSum>],
    pub(crate) tail: &'a mut [Block<T>; 3],
    pub(crate) rows: &'a mut [DenoisedRow<T>],
    /// The number of entries of `rows` in use, a power of two.
    pub(crate) slots: usize,
    /// The first and the last row that windows may reach.
    pub(crate) reachable_rows: (usize, usize),
    /// The blocks that are asked for.
    pub(crate) run: Range<usize>,
}

impl<'a, T: VectorPixel> Denoiser<'a, T> {
    /// Makes rows available: at most a batch and one row on each side of it.
    #[inline(always)]
    pub(crate) fn ensure_rows(&mut self, rows: Range<usize>) {
        let is_available = |y: usize| {
            let row_and_run = &self.slot(y).row_and_run;
            row_and_run.as_ref().is_some_and(|(row, run)| *row == y && *run == self.run)
        };
        let mut missing = rows;
        while missing.start < missing.end && is_available(missing.start) {
            missing.start += 1;
        }
        let plan = self.plan;
        // The windows of the features reach beyond the blocks that are asked for.
        let margin = plan.margin_blocks();
        let span = self.run.start.saturating_sub(margin)..(self.run.end + margin).min(plan.blocks);
        if plan.filter.has_window() {
            for y in missing.clone() {
                self.compute_columns(y, &span, y - missing.start);
            }
        }
        for y in missing.clone() {
            self.fill_row(y, &span, y - missing.start);
        }
    }

    /// Returns the run's blocks of row `y`. The row must be available.
    #[inline(always)]
    pub(crate) fn row(&self, y: usize) -> &[Block<T>] {
        self.slot(y).pixels.blocks(&self.run)
    }

    /// Returns the windows of row `y`. The row and its neighbors must be available.
    #[inline(always)]
    pub(crate) fn windows(&self, y: usize) -> WindowRows<'_, T> {
        let [above, here, below] = self.window_rows(y);
        let extended_row = |y: usize| self.slot(y).pixels.blocks_with_neighbors(&self.run);
        WindowRows {
            above: extended_row(above),
            here: extended_row(here),
            below: extended_row(below),
        }
    }

    /// Returns the numbers of the three rows that a window in row `y` covers.
    #[inline(always)]
    pub(crate) fn window_rows(&self, y: usize) -> [usize; 3] {
        [y.saturating_sub(1).max(self.reachable_rows.0), y, (y + 1).min(self.reachable_rows.1)]
    }

    #[inline(always)]
    fn slot(&self, y: usize) -> &DenoisedRow<T> {
        &self.rows[y & (self.slots - 1)]
    }

    /// Fills row `y` from the columns with index `at`, or from raw pixels.
    #[inline(always)]
    fn fill_row(&mut self, y: usize, span: &Range<usize>, at: usize) {
        let plan = self.plan;
        match plan.filter {
            DenoiseFilter::None => self.fill_raw(y, span),
            DenoiseFilter::Median3x3 => self.fill_medians(y, span, at),
            DenoiseFilter::Switching3x3 => {
                self.fill_raw(y, span);
                self.replace_extremes(y, span, at);
            }
            DenoiseFilter::Binomial3x3 => self.fill_means(y, span, at),
        }
        let row = &mut self.rows[y & (self.slots - 1)];
        row.pixels.repeat_border(plan.padded_width(), plan.padded_width());
        row.row_and_run = Some((y, self.run.clone()));
    }

    /// Fills row `y` with raw pixels and their padding.
    #[inline(always)]
    fn fill_raw(&mut self, y: usize, span: &Range<usize>) {
        let (plan, raw) = (self.plan, self.raw.row(y));
        let columns = span.start * BLOCK_LENGTH..(span.end * BLOCK_LENGTH).min(plan.width);
        let pixels = &mut self.rows[y & (self.slots - 1)].pixels;
        pixels.values_mut()[columns.clone()].copy_from_slice(&raw[columns]);
        pixels.repeat_border(plan.width, plan.padded_width());
    }

    /// Fills row `y` with the medians of windows.
    #[inline(always)]
    fn fill_medians(&mut self, y: usize, span: &Range<usize>, at: usize) {
        let ahead = self.prefetched_blocks(y, span);
        let sorted = self.sorted[at].each_ref().map(|row| row.blocks_with_neighbors(span));
        let pixels = self.rows[y & (self.slots - 1)].pixels.blocks_mut(span);
        match &self.plan.seams {
            None => median::combine_columns(sorted, SharedSides, ahead, pixels),
            Some(seams) => median::combine_columns(sorted, seams.masks_of(span), ahead, pixels),
        }
    }

    /// Replaces the raw pixels of row `y` that are extremes of their windows.
    #[inline(always)]
    fn replace_extremes(&mut self, y: usize, span: &Range<usize>, at: usize) {
        let ahead = self.prefetched_blocks(y, span);
        let sorted = self.sorted[at].each_ref().map(|row| row.blocks_with_neighbors(span));
        let pixels = self.rows[y & (self.slots - 1)].pixels.blocks_mut(span);
        match &self.plan.seams {
            None => switching::replace_extremes(sorted, SharedSides, ahead, pixels),
            Some(seams) => {
                switching::replace_extremes(sorted, seams.masks_of(span), ahead, pixels);
            }
        }
    }

    /// Fills row `y` with the binomial means of windows.
    #[inline(always)]
    fn fill_means(&mut self, y: usize, span: &Range<usize>, at: usize) {
        let ahead = self.prefetched_blocks(y, span);
        let sums = self.column_sums[at].blocks_with_neighbors(span);
        let pixels = self.rows[y & (self.slots - 1)].pixels.blocks_mut(span);
        match &self.plan.seams {
            None => binomial::combine_columns(sums, SharedSides, ahead, pixels),
            Some(seams) => binomial::combine_columns(sums, seams.masks_of(span), ahead, pixels),
        }
    }

    /// Returns the raw blocks of a row that is needed soon after row `y`.
    #[inline(always)]
    fn prefetched_blocks(&self, y: usize, span: &Range<usize>) -> &'a [Block<T>] {
        let ahead = self.raw.row(y + PREFETCH_ROWS);
        blocks_of(ahead, (span.start * BLOCK_LENGTH).min(self.plan.width))
    }

    /// Computes what the filter needs of the columns of the three raw rows around `y`.
    #[inline(always)]
    fn compute_columns(&mut self, y: usize, span: &Range<usize>, at: usize) {
        let rows = self.window_rows(y).map(|y| self.raw.row(y));
        match self.plan.filter {
            DenoiseFilter::None => {}
            DenoiseFilter::Median3x3 | DenoiseFilter::Switching3x3 => {
                compute_all_blocks(self.plan, rows, self.tail, span, &mut self.sorted[at]);
            }
            DenoiseFilter::Binomial3x3 => {
                compute_all_blocks(self.plan, rows, self.tail, span, &mut self.column_sums[at]);
            }
        }
    }
}

/// Values of the columns of three raw rows.
trait WindowColumns<T: VectorPixel> {
    /// Computes the values of some blocks that begin at a column.
    fn compute_blocks(&mut self, rows: [&[Block<T>]; 3], start: usize);

    /// Repeats the values of the border columns of a row of `width` pixels outwards.
    fn repeat_border(&mut self, width: usize, padded: usize);
}

/// Sorted columns.
impl<T: VectorPixel> WindowColumns<T> for [BlockRow<T>; 3] {
    #[inline(always)]
    fn compute_blocks(&mut self, rows: [&[Block<T>]; 3], start: usize) {
        let count = rows[0].len();
        median::sort_columns(rows, self.each_mut().map(|row| row.blocks_at(start, count)));
    }

    #[inline(always)]
    fn repeat_border(&mut self, width: usize, padded: usize) {
        for row in self {
            row.repeat_border(width, padded);
        }
    }
}

/// Weighted sums of columns.
impl<T: VectorPixel> WindowColumns<T> for BlockRow<T::ColumnSum> {
    #[inline(always)]
    fn compute_blocks(&mut self, rows: [&[Block<T>]; 3], start: usize) {
        binomial::sum_columns(rows, self.blocks_at(start, rows[0].len()));
    }

    #[inline(always)]
    fn repeat_border(&mut self, width: usize, padded: usize) {
        self.repeat_border(width, padded);
    }
}

/// Computes the values of the columns of three raw rows, and of their padding.
#[inline(always)]
fn compute_all_blocks<T: VectorPixel>(
    plan: &CameraPlan<T>,
    rows: [&[T]; 3],
    tail: &mut [Block<T>; 3],
    span: &Range<usize>,
    columns: &mut impl WindowColumns<T>,
) {
    let width = plan.width;
    let whole = span.start..span.end.min(width / BLOCK_LENGTH);
    let start = whole.start * BLOCK_LENGTH;
    columns.compute_blocks(rows.map(|row| &blocks_of(row, start)[..whole.len()]), start);
    if whole.end < span.end {
        // The last block is ragged: it is computed together with pixels before it, or alone if
        // there are none.
        let start = width.saturating_sub(BLOCK_LENGTH);
        if start == 0 {
            for (tail, row) in tail.iter_mut().zip(rows) {
                tail[..width].copy_from_slice(row);
            }
        }
        let [a, b, c] = &*tail;
        let alone = [std::slice::from_ref(a), std::slice::from_ref(b), std::slice::from_ref(c)];
        let blocks = if start == 0 { alone } else { rows.map(|row| blocks_of(row, start)) };
        columns.compute_blocks(blocks, start);
    }
    columns.repeat_border(width, plan.padded_width());
}

/// Returns the whole blocks of a row from a column on.
#[inline(always)]
fn blocks_of<T>(row: &[T], start: usize) -> &[Block<T>] {
    row[start..].as_chunks().0
}
