// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `corner`: FAST 5/8.

use crate::kernel::{WindowRows, WindowSides, extended_block};
use crate::periphery::BlockLevels;
use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel, best_arc};

/// Adds one to every element whose pixel is a corner at its level.
#[inline(always)]
pub(crate) fn count_corners<T: VectorPixel>(
    windows: WindowRows<'_, T>,
    sides: impl WindowSides<T>,
    levels: impl BlockLevels<T>,
    hits: &mut [Block<T>],
) {
    for (at, hits) in hits.iter_mut().enumerate() {
        let above = extended_block(windows.above, at);
        let here = extended_block(windows.here, at);
        let below = extended_block(windows.below, at);
        let mut sums = *hits;
        for i in 0..BLOCK_LENGTH {
            let (nw, n, ne) = sides.window_row(above, at, i);
            let (w, center, e) = sides.window_row(here, at, i);
            let (sw, s, se) = sides.window_row(below, at, i);
            let level = levels.level(at, i);
            let ring = [nw, n, ne, e, se, s, sw, w];
            let bright = best_arc(ring, T::min, T::max) > center.saturating_plus(level);
            let dark = best_arc(ring, T::max, T::min) < center.saturating_minus(level);
            sums[i] += T::from_hit(bright | dark);
        }
        *hits = sums;
    }
}
