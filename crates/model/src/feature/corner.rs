// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `corner`, FAST 5/8: pixels with five contiguous neighbors that are all brighter or
//! all darker.

use crate::window::{CENTER, PixelWindow};

/// The positions of the neighbors of the center in a window, clockwise from the upper left.
const RING: [usize; 8] = [0, 1, 2, 5, 8, 7, 6, 3];
/// Number of contiguous neighbors that make a corner.
const ARC: usize = 5;

/// Returns the largest level at which the center is a corner: it is one if and only if
/// `level <= strength`. Returns `None` if the center is not a corner at any level.
///
/// All pixels of an arc are brighter than `p + level` if and only if the smallest `x - p` of the
/// arc is above the level. So the best arc decides, and its difference must be at least 1 for level
/// 0.
#[must_use]
pub fn corner_strength(window: &PixelWindow) -> Option<u32> {
    let center = i32::from(window[CENTER]);
    let over = RING.map(|place| i32::from(window[place]) - center);
    let arcs = (0..over.len()).map(|start| {
        let arc = || (start..start + ARC).map(|place| over[place % over.len()]);
        let brighter = arc().min().expect("an arc has pixels");
        let darker = arc().max().expect("an arc has pixels");
        brighter.max(-darker)
    });
    let best = arcs.max().expect("there are arcs");
    u32::try_from(best - 1).ok()
}
