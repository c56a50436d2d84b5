// SPDX-License-Identifier: MIT OR Apache-2.0
//! Counters and votes, a row of lanes each.

use foveate_lanes::{BLOCK, Block, Lane};

use crate::rows::Row;
use crate::wide::{Count, Types};

/// Adds hits, 1 or 0 each.
#[inline(always)]
pub(crate) fn add_hits<Y: Types>(counts: &mut Row<Y::Count>, hits: &[Block<Y::Pixel>]) {
    for (counts, hits) in counts.blocks_mut().iter_mut().zip(hits) {
        for lane in 0..BLOCK {
            counts[lane] = counts[lane].plus(Y::count(hits[lane]));
        }
    }
}

/// Adds one to every lane.
#[inline(always)]
pub(crate) fn add_all<Y: Types>(counts: &mut Row<Y::Count>) {
    for count in counts.iter_mut() {
        *count = count.plus(Y::count(Y::Pixel::ONE));
    }
}

/// Adds one where two values differ by more than `level`, and where `force` is 1.
#[inline(always)]
pub(crate) fn add_changes<Y: Types>(
    counts: &mut Row<Y::Count>,
    now: &[Block<Y::Pixel>],
    reference: &[Block<Y::Pixel>],
    level: Y::Pixel,
    force: Option<&Row<Y::Pixel>>,
) {
    for (at, counts) in counts.blocks_mut().iter_mut().enumerate() {
        let (now, reference) = (&now[at], &reference[at]);
        let mut hits = [Y::Pixel::default(); BLOCK];
        for lane in 0..BLOCK {
            hits[lane] = Y::Pixel::hit(now[lane].distance(reference[lane]) > level);
        }
        if let Some(force) = force {
            let force = &force.blocks()[at];
            for lane in 0..BLOCK {
                hits[lane] = hits[lane].max(force[lane]);
            }
        }
        for lane in 0..BLOCK {
            counts[lane] = counts[lane].plus(Y::count(hits[lane]));
        }
    }
}

/// 1 where a score reaches the minimum; nowhere, if none can.
#[inline(always)]
pub(crate) fn reach<V: Copy + Ord>(scores: &[V], minimum: Option<V>, votes: &mut [u8]) {
    match minimum {
        None => votes.fill(0),
        Some(minimum) => {
            for (vote, score) in votes.iter_mut().zip(scores) {
                *vote = u8::from(*score >= minimum);
            }
        }
    }
}
