// SPDX-License-Identifier: MIT OR Apache-2.0
//! Denoised rows on demand: the last three are kept, so that a window's rows are computed once.

use std::ops::Range;

use crate::kernel::{Open, Seams, Windows, median};
use crate::lane::{BLOCK, Block, Lane};
use crate::pixels::Pixels;
use crate::plan::{Plan, SeamMasks};
use crate::scratch::{DenoisedRow, Row};

impl<T: Lane> SeamMasks<T> {
    /// Those of some blocks.
    #[inline(always)]
    pub(crate) fn over(&self, span: &Range<usize>) -> Seams<'_, T> {
        Seams { first: &self.first.blocks()[span.clone()], last: &self.last.blocks()[span.clone()] }
    }
}

/// The rows of one run of blocks, padding and borders as the contract says.
#[derive(Debug)]
pub(crate) struct Denoiser<'a, T: Lane> {
    pub(crate) plan: &'a Plan<T>,
    pub(crate) raw: Pixels<'a, T>,
    pub(crate) sorted: &'a mut [Row<T>; 3],
    pub(crate) tail: &'a mut [Block<T>; 3],
    pub(crate) rows: &'a mut [DenoisedRow<T>; 3],
    /// First and last row that windows may reach.
    pub(crate) reach: (usize, usize),
    /// The blocks that are wanted.
    pub(crate) run: Range<usize>,
}

impl<T: Lane> Denoiser<'_, T> {
    /// Row `y` of the blocks that are wanted.
    #[inline(always)]
    pub(crate) fn row(&mut self, y: usize) -> &[Block<T>] {
        self.ensure(y);
        self.rows[y % 3].pixels.blocks(&self.run)
    }

    /// The windows of row `y`.
    #[inline(always)]
    pub(crate) fn windows(&mut self, y: usize) -> Windows<'_, T> {
        let (above, below) = (y.saturating_sub(1).max(self.reach.0), (y + 1).min(self.reach.1));
        self.ensure(above);
        self.ensure(y);
        self.ensure(below);
        let near = |y: usize| self.rows[y % 3].pixels.near(&self.run);
        Windows { above: near(above), here: near(y), below: near(below) }
    }

    #[inline(always)]
    fn ensure(&mut self, y: usize) {
        let held = &self.rows[y % 3].holds;
        if !held.as_ref().is_some_and(|(row, run)| *row == y && *run == self.run) {
            self.compute(y);
        }
    }

    /// One block more on each side than is wanted, since the windows of features reach there.
    #[inline(always)]
    fn span(&self) -> Range<usize> {
        self.run.start.saturating_sub(1)..(self.run.end + 1).min(self.plan.blocks)
    }

    #[inline(always)]
    fn compute(&mut self, y: usize) {
        let (plan, span) = (self.plan, self.span());
        if plan.median {
            let above = y.saturating_sub(1).max(self.reach.0);
            let below = (y + 1).min(self.reach.1);
            self.sort([above, y, below], &span);
        }
        let row = &mut self.rows[y % 3];
        if plan.median {
            let [low, mid, high] = &*self.sorted;
            let sorted = [low.near(&span), mid.near(&span), high.near(&span)];
            let pixels = row.pixels.blocks_mut(&span);
            match &plan.seams {
                None => median::combine(sorted, Open, pixels),
                Some(seams) => median::combine(sorted, seams.over(&span), pixels),
            }
            row.pixels.repeat_border(plan.padded_width(), plan.padded_width());
        } else {
            let columns = span.start * BLOCK..(span.end * BLOCK).min(plan.width);
            let raw = self.raw.row(y);
            row.pixels.values_mut()[columns.clone()].copy_from_slice(&raw[columns]);
            row.pixels.repeat_border(plan.width, plan.padded_width());
        }
        row.holds = Some((y, self.run.clone()));
    }

    /// Sorts the columns of three raw rows.
    #[inline(always)]
    fn sort(&mut self, rows: [usize; 3], span: &Range<usize>) {
        let width = self.plan.width;
        let [a, b, c] = rows;
        let rows = [self.raw.row(a), self.raw.row(b), self.raw.row(c)];
        let whole = span.start..span.end.min(width / BLOCK);
        let [low, mid, high] = &mut *self.sorted;
        let sorted = [low.blocks_mut(&whole), mid.blocks_mut(&whole), high.blocks_mut(&whole)];
        median::sort_columns(each(rows, whole.start * BLOCK), sorted);
        if whole.end < span.end {
            // The last block that is not whole: together with pixels before it, or by itself.
            let start = width.saturating_sub(BLOCK);
            let sorted = [low.blocks_at(start), mid.blocks_at(start), high.blocks_at(start)];
            if start > 0 {
                median::sort_columns(each(rows, start), sorted);
            } else {
                for (tail, row) in self.tail.iter_mut().zip(rows) {
                    tail[..width].copy_from_slice(row);
                }
                let [a, b, c] = &*self.tail;
                median::sort_columns([&[*a], &[*b], &[*c]], sorted);
            }
        }
        for row in &mut *self.sorted {
            row.repeat_border(width, self.plan.padded_width());
        }
    }
}

/// Blocks of three rows from a column on.
#[inline(always)]
fn each<T>([a, b, c]: [&[T]; 3], start: usize) -> [&[Block<T>]; 3] {
    [a[start..].as_chunks().0, b[start..].as_chunks().0, c[start..].as_chunks().0]
}
