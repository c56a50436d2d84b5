// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `corner`: FAST 5/8.

use crate::kernel::{Sides, Windows, near};
use foveate_lanes::{BLOCK, Block, Lane, best_arc};

/// Adds one to every lane whose pixel is a corner at `level`.
#[inline(always)]
pub(crate) fn count<T: Lane>(
    windows: Windows<'_, T>,
    sides: impl Sides<T>,
    level: T,
    hits: &mut [Block<T>],
) {
    for (at, hits) in hits.iter_mut().enumerate() {
        let above = near(windows.above, at);
        let here = near(windows.here, at);
        let below = near(windows.below, at);
        let mut sums = *hits;
        for i in 0..BLOCK {
            let (nw, n, ne) = sides.see(above, at, i);
            let (w, center, e) = sides.see(here, at, i);
            let (sw, s, se) = sides.see(below, at, i);
            let ring = [nw, n, ne, e, se, s, sw, w];
            let bright = best_arc(ring, T::min, T::max) > center.plus(level);
            let dark = best_arc(ring, T::max, T::min) < center.minus(level);
            sums[i] += T::hit(bright | dark);
        }
        *hits = sums;
    }
}
