// SPDX-License-Identifier: MIT OR Apache-2.0
//! How unevenly something is sent: bits in windows of one length, one after the other from the first
//! frame on.

use serde::Serialize;

use crate::Unit;

/// Rates in windows of one length, in bytes per second, rounded to the nearest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Rates {
    /// Length of a window in ms.
    pub window_ms: u64,
    /// 99 of 100 windows have this rate or a lower one (nearest rank).
    pub p99: u64,
    /// The highest.
    pub peak: u64,
}

impl Rates {
    /// The rates between `start` and `end`, in ns, and after it as long as something is sent. The last
    /// window counts as whole.
    #[must_use]
    pub fn of(units: &[Unit], (start, end): (u64, u64), window_ms: u64) -> Self {
        let length = window_ms * 1_000_000;
        let number = |unit: &Unit| (unit.sent.saturating_sub(start) / length) as usize;
        let during = end.saturating_sub(start).div_ceil(length) as usize;
        let count = units.iter().map(|unit| number(unit) + 1).max().unwrap_or(0).max(during);
        let mut bits = vec![0_u64; count.max(1)];
        units.iter().for_each(|unit| bits[number(unit)] += unit.bits);
        bits.sort_unstable();
        let rate = |bits: u64| (bits * 125 + window_ms / 2) / window_ms;
        let p99 = rate(nearest_rank(&bits, 99));
        Self { window_ms, p99, peak: rate(nearest_rank(&bits, 100)) }
    }
}

/// The smallest of some sorted values that is not below `percent` of them; 0 of none.
pub(crate) fn nearest_rank(sorted: &[u64], percent: usize) -> u64 {
    let rank = (sorted.len() * percent).div_ceil(100);
    rank.checked_sub(1).map_or(0, |at| sorted[at])
}
