// SPDX-License-Identifier: MIT OR Apache-2.0
//! The temporal score: the number of pixels that differ from their reference by more than a level.

use foveate_lanes::{BLOCK_LANES, Block, PixelLane};

/// Adds one to every lane that has changed, and replaces the reference by the current pixels.
#[inline(always)]
pub(crate) fn count_and_replace<T: PixelLane>(
    now: &[Block<T>],
    reference: &mut [Block<T>],
    level: T,
    hits: &mut [Block<T>],
) {
    for ((now, reference), hits) in now.iter().zip(reference).zip(hits) {
        let mut sums = *hits;
        for i in 0..BLOCK_LANES {
            sums[i] += changed(now[i], reference[i], level);
        }
        *hits = sums;
        *reference = *now;
    }
}

/// Adds one to every lane that has changed, and writes the current pixels to `store`. The reference
/// stays.
#[inline(always)]
pub(crate) fn count_and_store<T: PixelLane>(
    now: &[Block<T>],
    reference: &[Block<T>],
    level: T,
    hits: &mut [Block<T>],
    store: &mut [Block<T>],
) {
    for (((now, reference), hits), store) in now.iter().zip(reference).zip(hits).zip(store) {
        let mut sums = *hits;
        for i in 0..BLOCK_LANES {
            sums[i] += changed(now[i], reference[i], level);
        }
        *hits = sums;
        *store = *now;
    }
}

/// Returns one if the pixel has changed, otherwise zero.
#[inline(always)]
fn changed<T: PixelLane>(now: T, reference: T, level: T) -> T {
    now.absolute_difference(reference).saturating_minus(level).min(T::ONE)
}
