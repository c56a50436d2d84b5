// SPDX-License-Identifier: MIT OR Apache-2.0
//! `edge`: `|Gx| + |Gy| > level` without either gradient.
//!
//! `|Gx| + |Gy|` is the larger of `|Gx + Gy|` and `|Gx - Gy|`. Both are even, and half of each is a
//! sum of three differences of pixels, which is compared with half the level, rounded down.

use crate::kernel::Windows;
use crate::lane::{BLOCK, Block, Lane};

/// Adds one to every lane whose window is an edge; `half` is half of the level, rounded down.
#[inline(always)]
pub(crate) fn count<T: Lane>(windows: Windows<'_, T>, half: T::Signed, hits: &mut [Block<T>]) {
    let blocks = hits.len();
    let Windows { above, here, below } = windows;
    let (above, here, below) = (above.of(blocks), here.of(blocks), below.of(blocks));
    for (at, hits) in hits.iter_mut().enumerate() {
        for i in 0..BLOCK {
            let pixel = |row: &[Block<T>]| T::Signed::from(row[at][i]);
            let across = pixel(here.east) - pixel(here.west);
            let down = pixel(below.center) - pixel(above.center);
            let falling = pixel(below.east) - pixel(above.west);
            let rising = pixel(above.east) - pixel(below.west);
            let sum = across + down + falling;
            let difference = across - down + rising;
            let larger = sum.max(-sum).max(difference.max(-difference));
            hits[i] += T::hit(larger > half);
        }
    }
}
