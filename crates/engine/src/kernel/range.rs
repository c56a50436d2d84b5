// SPDX-License-Identifier: MIT OR Apache-2.0
//! `range`: the smallest and the largest pixel of every column, and then of every region.

use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

/// Replaces the extremes of every column by those of the column with one more row.
#[inline(always)]
pub(crate) fn update_extremes<T: VectorPixel>(
    pixels: &[Block<T>],
    smallest: &mut [Block<T>],
    largest: &mut [Block<T>],
) {
    for ((pixels, smallest), largest) in pixels.iter().zip(smallest).zip(largest) {
        for i in 0..BLOCK_LENGTH {
            smallest[i] = smallest[i].min(pixels[i]);
            largest[i] = largest[i].max(pixels[i]);
        }
    }
}

/// Computes the range of every region from the extremes of its columns. A region has `side`
/// columns.
#[inline(always)]
pub(crate) fn ranges_by_region<T: VectorPixel>(
    smallest: &[T],
    largest: &[T],
    side: usize,
    ranges: &mut [u64],
) {
    let columns = smallest.chunks_exact(side).zip(largest.chunks_exact(side));
    for ((smallest, largest), range) in columns.zip(ranges) {
        let low = smallest.iter().fold(T::MAX, |low, &column| low.min(column));
        let high = largest.iter().fold(T::default(), |high, &column| high.max(column));
        *range = high.saturating_minus(low).into();
    }
}
