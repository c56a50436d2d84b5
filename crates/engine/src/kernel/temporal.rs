// SPDX-License-Identifier: MIT OR Apache-2.0
//! The temporal score: the number of pixels that differ from their reference by more than their
//! level.

use crate::periphery::BlockLevels;
use foveate_pixels::vectors::{BLOCK_LENGTH, Block, VectorPixel};

/// Adds one to every element that has changed, and replaces the reference by the current pixels.
#[inline(always)]
pub(crate) fn count_and_replace<T: VectorPixel>(
    now: &[Block<T>],
    reference: &mut [Block<T>],
    levels: impl BlockLevels<T>,
    hits: &mut [Block<T>],
) {
    for (at, ((now, reference), hits)) in now.iter().zip(reference).zip(hits).enumerate() {
        let mut sums = *hits;
        for i in 0..BLOCK_LENGTH {
            sums[i] += changed(now[i], reference[i], levels.level(at, i));
        }
        *hits = sums;
        *reference = *now;
    }
}

/// Adds one to every element that has changed, and writes the current pixels to `store`. The
/// reference stays.
#[inline(always)]
pub(crate) fn count_and_store<T: VectorPixel>(
    now: &[Block<T>],
    reference: &[Block<T>],
    levels: impl BlockLevels<T>,
    hits: &mut [Block<T>],
    store: &mut [Block<T>],
) {
    let blocks = now.iter().zip(reference).zip(hits).zip(store);
    for (at, (((now, reference), hits), store)) in blocks.enumerate() {
        let mut sums = *hits;
        for i in 0..BLOCK_LENGTH {
            sums[i] += changed(now[i], reference[i], levels.level(at, i));
        }
        *hits = sums;
        *store = *now;
    }
}

/// Returns one if the pixel has changed, otherwise zero.
#[inline(always)]
fn changed<T: VectorPixel>(now: T, reference: T, level: T) -> T {
    now.absolute_difference(reference).saturating_minus(level).min(T::ONE)
}
