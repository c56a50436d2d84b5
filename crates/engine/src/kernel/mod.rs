// SPDX-License-Identifier: MIT OR Apache-2.0
//! The arithmetic on blocks of elements: one file per step, with plain loops that the compiler
//! vectorises.
//!
//! The slices of blocks that one call takes are equally long. A loop that pairs them stops at the
//! shortest.
#![allow(
    clippy::needless_range_loop,
    clippy::manual_memcpy,
    reason = "elements by number, in one loop: what vectorises"
)]

pub(crate) mod binomial;
pub(crate) mod corner;
pub(crate) mod edge;
pub(crate) mod flow;
pub(crate) mod mad;
pub(crate) mod median;
pub(crate) mod range;
pub(crate) mod segment;
pub(crate) mod sums;
pub(crate) mod surface;
pub(crate) mod switching;
pub(crate) mod temporal;

use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

/// A row that has one element before its first block and one element after its last.
pub(crate) type ExtendedRow<'a, T> = &'a [T];

/// Returns block `at` of such a row, with the element before it and the element after it.
#[inline(always)]
pub(crate) fn extended_block<T>(row: ExtendedRow<'_, T>, at: usize) -> &[T; BLOCK_LENGTH + 2] {
    row[at * BLOCK_LENGTH..].first_chunk().expect("one element more on each side")
}

/// The three rows that the windows of a row cover.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WindowRows<'a, T> {
    pub(crate) above: ExtendedRow<'a, T>,
    pub(crate) here: ExtendedRow<'a, T>,
    pub(crate) below: ExtendedRow<'a, T>,
}

/// The pixels that windows see beyond the sides of a region.
pub(crate) trait WindowSides<T: VectorPixel>: Copy {
    /// Returns the pixels at the left, center and right of the window of element `i` of block `at`,
    /// in one row.
    fn window_row(self, row: &[T; BLOCK_LENGTH + 2], at: usize, i: usize) -> (T, T, T);

    /// Returns the sums of the left, center and right column of the window of element `i` of block
    /// `at`.
    fn window_sums(
        self,
        row: &[T::ColumnSum; BLOCK_LENGTH + 2],
        at: usize,
        i: usize,
    ) -> (T::ColumnSum, T::ColumnSum, T::ColumnSum);
}

/// The neighborhood `shared`: windows see the real neighbors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SharedSides;

/// The neighborhood `isolated`: windows see the region's own border pixel. Every bit of a mask is
/// set in the first and in the last columns of regions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IsolatedSides<'a, T> {
    pub(crate) first: &'a [Block<T>],
    pub(crate) last: &'a [Block<T>],
}

impl<T: VectorPixel> WindowSides<T> for SharedSides {
    #[inline(always)]
    fn window_row(self, row: &[T; BLOCK_LENGTH + 2], _at: usize, i: usize) -> (T, T, T) {
        (row[i], row[i + 1], row[i + 2])
    }

    #[inline(always)]
    fn window_sums(
        self,
        row: &[T::ColumnSum; BLOCK_LENGTH + 2],
        _at: usize,
        i: usize,
    ) -> (T::ColumnSum, T::ColumnSum, T::ColumnSum) {
        (row[i], row[i + 1], row[i + 2])
    }
}

impl<T: VectorPixel> WindowSides<T> for IsolatedSides<'_, T> {
    #[inline(always)]
    fn window_row(self, row: &[T; BLOCK_LENGTH + 2], at: usize, i: usize) -> (T, T, T) {
        let center = row[i + 1];
        (
            select(self.first[at][i], center, row[i]),
            center,
            select(self.last[at][i], center, row[i + 2]),
        )
    }

    #[inline(always)]
    fn window_sums(
        self,
        row: &[T::ColumnSum; BLOCK_LENGTH + 2],
        at: usize,
        i: usize,
    ) -> (T::ColumnSum, T::ColumnSum, T::ColumnSum) {
        let center = row[i + 1];
        let side = |mask: T, side| if mask == T::MAX { center } else { side };
        (side(self.first[at][i], row[i]), center, side(self.last[at][i], row[i + 2]))
    }
}

/// Returns `yes` where the mask is set, otherwise `no`.
#[inline(always)]
fn select<T: VectorPixel>(mask: T, yes: T, no: T) -> T {
    no ^ ((yes ^ no) & mask)
}
