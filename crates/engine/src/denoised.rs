// SPDX-License-Identifier: MIT OR Apache-2.0
//! Denoised rows, computed on demand. The rows around a batch are kept, so that each row is
//! computed once although several windows use it.

use std::ops::Range;

use crate::kernel::{IsolatedSides, SharedSides, WindowRows, median};
use crate::pixels::BorrowedFrame;
use crate::plan::{CameraPlan, SeamMasks};
use crate::working_memory::{BlockRow, DenoisedRow};
use foveate_lanes::{BLOCK_LANES, Block, PixelLane};

impl<T: PixelLane> SeamMasks<T> {
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
pub(crate) struct Denoiser<'a, T: PixelLane> {
    pub(crate) plan: &'a CameraPlan<T>,
    pub(crate) raw: BorrowedFrame<'a, T>,
    pub(crate) sorted: &'a mut [[BlockRow<T>; 3]],
    pub(crate) tail: &'a mut [Block<T>; 3],
    pub(crate) rows: &'a mut [DenoisedRow<T>],
    /// The number of entries of `rows` in use, a power of two.
    pub(crate) slots: usize,
    /// The first and the last row that windows may reach.
    pub(crate) reachable_rows: (usize, usize),
    /// The blocks that are asked for.
    pub(crate) run: Range<usize>,
}

impl<T: PixelLane> Denoiser<'_, T> {
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
        if plan.median {
            for y in missing.clone() {
                self.sort_row_columns(y, &span, y - missing.start);
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

    /// Fills row `y` from the sorted columns with index `at`, or from raw pixels if there is no
    /// median.
    #[inline(always)]
    fn fill_row(&mut self, y: usize, span: &Range<usize>, at: usize) {
        let plan = self.plan;
        let row = &mut self.rows[y & (self.slots - 1)];
        if plan.median {
            let [low, mid, high] = &self.sorted[at];
            let sorted = [
                low.blocks_with_neighbors(span),
                mid.blocks_with_neighbors(span),
                high.blocks_with_neighbors(span),
            ];
            let pixels = row.pixels.blocks_mut(span);
            let ahead = self.raw.row(y + PREFETCH_ROWS);
            let ahead = blocks_of(ahead, (span.start * BLOCK_LANES).min(plan.width));
            match &plan.seams {
                None => median::combine_columns(sorted, SharedSides, ahead, pixels),
                Some(seams) => median::combine_columns(sorted, seams.masks_of(span), ahead, pixels),
            }
            row.pixels.repeat_border(plan.padded_width(), plan.padded_width());
        } else {
            let columns = span.start * BLOCK_LANES..(span.end * BLOCK_LANES).min(plan.width);
            let raw = self.raw.row(y);
            row.pixels.values_mut()[columns.clone()].copy_from_slice(&raw[columns]);
            row.pixels.repeat_border(plan.width, plan.padded_width());
        }
        row.row_and_run = Some((y, self.run.clone()));
    }

    /// Sorts the columns of the three raw rows around `y`.
    #[inline(always)]
    fn sort_row_columns(&mut self, y: usize, span: &Range<usize>, at: usize) {
        let width = self.plan.width;
        let [a, b, c] = self.window_rows(y);
        let rows = [self.raw.row(a), self.raw.row(b), self.raw.row(c)];
        let whole = span.start..span.end.min(width / BLOCK_LANES);
        let [low, mid, high] = &mut self.sorted[at];
        let sorted = [low.blocks_mut(&whole), mid.blocks_mut(&whole), high.blocks_mut(&whole)];
        let start = whole.start * BLOCK_LANES;
        median::sort_columns(blocks_of_rows(rows, start), sorted);
        if whole.end < span.end {
            // The last block is ragged: it is sorted together with pixels before it, or alone if
            // there are none.
            let start = width.saturating_sub(BLOCK_LANES);
            let sorted = [low.blocks_at(start), mid.blocks_at(start), high.blocks_at(start)];
            if start > 0 {
                median::sort_columns(blocks_of_rows(rows, start), sorted);
            } else {
                for (tail, row) in self.tail.iter_mut().zip(rows) {
                    tail[..width].copy_from_slice(row);
                }
                let [a, b, c] = &*self.tail;
                median::sort_columns([&[*a], &[*b], &[*c]], sorted);
            }
        }
        for row in [low, mid, high] {
            row.repeat_border(width, self.plan.padded_width());
        }
    }
}

/// Returns the whole blocks of a row from a column on.
#[inline(always)]
fn blocks_of<T>(row: &[T], start: usize) -> &[Block<T>] {
    row[start..].as_chunks().0
}

/// Returns the whole blocks of three rows from a column on.
#[inline(always)]
fn blocks_of_rows<T>([a, b, c]: [&[T]; 3], start: usize) -> [&[Block<T>]; 3] {
    [blocks_of(a, start), blocks_of(b, start), blocks_of(c, start)]
}
