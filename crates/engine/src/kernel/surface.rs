// SPDX-License-Identifier: MIT OR Apache-2.0
//! `surface`: the sums of the absolute differences between every pixel and its neighbors to the
//! right, below, below to the right and below to the left.

use crate::kernel::{WindowRows, WindowSides, extended_block};
use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

pub(crate) const DISPLACEMENTS: usize = 4;

/// Adds the differences of every window to the sums of its column.
#[inline(always)]
pub(crate) fn add_differences<T: VectorPixel>(
    windows: WindowRows<'_, T>,
    sides: impl WindowSides<T>,
    sums: [&mut [Block<T::ColumnSum>]; DISPLACEMENTS],
) {
    let [right, below, below_right, below_left] = sums;
    let sums = right.iter_mut().zip(below).zip(below_right).zip(below_left);
    for (at, (((right, below), below_right), below_left)) in sums.enumerate() {
        let here = extended_block(windows.here, at);
        let under = extended_block(windows.below, at);
        for i in 0..BLOCK_LENGTH {
            let (_, center, e) = sides.window_row(here, at, i);
            let (sw, s, se) = sides.window_row(under, at, i);
            let difference = |other| T::ColumnSum::from(center.absolute_difference(other));
            right[i] += difference(e);
            below[i] += difference(s);
            below_right[i] += difference(se);
            below_left[i] += difference(sw);
        }
    }
}
