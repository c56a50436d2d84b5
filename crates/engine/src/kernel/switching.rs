// SPDX-License-Identifier: MIT OR Apache-2.0
//! `switching3x3`: the median of the window where the pixel is its largest or smallest value.

use crate::kernel::median::median_of_columns;
use crate::kernel::{ExtendedRow, WindowSides, extended_block};
use foveate_pixels::{
    vectors::prefetch,
    vectors::{BLOCK_LENGTH, Block, VectorPixel},
};

/// Replaces every raw pixel of `pixels` that is an extreme of its window by the median, which
/// follows from the three sorted columns of the window, as the extremes do. Prefetches `ahead`, raw
/// pixels that will be sorted some rows later.
#[inline(always)]
pub(crate) fn replace_extremes<T: VectorPixel>(
    [low, mid, high]: [ExtendedRow<'_, T>; 3],
    sides: impl WindowSides<T>,
    ahead: &[Block<T>],
    pixels: &mut [Block<T>],
) {
    for (at, pixels) in pixels.iter_mut().enumerate() {
        if let Some(ahead) = ahead.get(at) {
            prefetch(ahead);
        }
        let (low, mid, high) =
            (extended_block(low, at), extended_block(mid, at), extended_block(high, at));
        let centers = *pixels;
        let mut results = [T::default(); BLOCK_LENGTH];
        for i in 0..BLOCK_LENGTH {
            let low = sides.window_row(low, at, i);
            let high = sides.window_row(high, at, i);
            let median = median_of_columns(low, sides.window_row(mid, at, i), high);
            let smallest = low.0.min(low.1).min(low.2);
            let largest = high.0.max(high.1).max(high.2);
            let center = centers[i];
            let is_extreme = (center == smallest) | (center == largest);
            results[i] = if is_extreme { median } else { center };
        }
        *pixels = results;
    }
}
