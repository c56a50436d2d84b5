// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `edge`: `|Gx| + |Gy| > level`, computed without either gradient.
//!
//! `|Gx| + |Gy|` is the larger of `|Gx + Gy|` and `|Gx - Gy|`. Both are even, and half of each is a
//! sum of three differences of pixels. It is compared with half the level, rounded down.

use crate::kernel::{WindowRows, WindowSides, extended_block};
use crate::periphery::BlockLevels;
use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

/// Adds one to every element whose window is an edge. `halves` are half of the levels, rounded
/// down.
#[inline(always)]
pub(crate) fn count_edges<T: VectorPixel>(
    windows: WindowRows<'_, T>,
    sides: impl WindowSides<T>,
    halves: impl BlockLevels<T::Signed>,
    hits: &mut [Block<T>],
) {
    for (at, hits) in hits.iter_mut().enumerate() {
        let above = extended_block(windows.above, at);
        let here = extended_block(windows.here, at);
        let below = extended_block(windows.below, at);
        let mut sums = *hits;
        for i in 0..BLOCK_LENGTH {
            let (nw, n, ne) = sides.window_row(above, at, i);
            let (w, _, e) = sides.window_row(here, at, i);
            let (sw, s, se) = sides.window_row(below, at, i);
            let minus = |a, b| T::Signed::from(a) - T::Signed::from(b);
            let (across, down) = (minus(e, w), minus(s, n));
            let sum = across + down + minus(se, nw);
            let difference = across - down + minus(ne, sw);
            let larger = sum.max(-sum).max(difference.max(-difference));
            sums[i] += T::from_hit(larger > halves.level(at, i));
        }
        *hits = sums;
    }
}
