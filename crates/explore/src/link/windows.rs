// SPDX-License-Identifier: MIT OR Apache-2.0
//! The variation of a rate: bits are counted in windows of one length, one after the other from the
//! first frame on.

use crate::link::LinkUnit;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The rates in windows of one length, in bytes per second, rounded to the nearest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WindowRates {
    /// The length of a window in ms.
    pub window_ms: u64,
    /// The rate that 99 of 100 windows do not exceed (nearest rank).
    pub p99: u64,
    /// The highest rate.
    pub peak: u64,
}

impl WindowRates {
    /// Computes the rates between `start` and `end`, in ns, and after `end` as long as bits are
    /// sent. The last window counts as a whole window.
    #[must_use]
    pub fn from_units(units: &[LinkUnit], (start, end): (u64, u64), window_ms: u64) -> Self {
        let length = window_ms * 1_000_000;
        // Only windows with bits are stored, because a clip may last for days.
        let mut windows: BTreeMap<u64, u64> = BTreeMap::new();
        for unit in units {
            *windows.entry(unit.sent_ns.saturating_sub(start) / length).or_default() += unit.bits;
        }
        let during = end.saturating_sub(start).div_ceil(length);
        let count = windows.last_key_value().map_or(0, |(last, _)| last + 1).max(during);
        let empty = count - windows.len() as u64;
        let mut bits: Vec<u64> = windows.into_values().collect();
        bits.sort_unstable();
        let rate = |percent: u64| {
            let rank = (count * percent).div_ceil(100);
            let bits = rank.checked_sub(empty + 1).map_or(0, |at| {
                bits[usize::try_from(at).expect("there are as many windows in memory")]
            });
            (bits * 125 + window_ms / 2) / window_ms
        };
        Self { window_ms, p99: rate(99), peak: rate(100) }
    }
}

/// Returns the smallest of some sorted values that at least `percent` % of them do not exceed; 0
/// without values.
pub(crate) fn nearest_rank(sorted: &[u64], percent: usize) -> u64 {
    let rank = (sorted.len() * percent).div_ceil(100);
    rank.checked_sub(1).map_or(0, |at| sorted[at])
}
