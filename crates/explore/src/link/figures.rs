// SPDX-License-Identifier: MIT OR Apache-2.0
//! The figures of the load that one sender puts on a link.

use serde::{Deserialize, Serialize};

use super::windows::nearest_rank;
use crate::link::{LinkUnit, Timeline, WindowRates, send_over_link};

/// The lengths of the windows in ms.
pub(crate) const WINDOWS_MS: [u64; 3] = [1, 10, 100];

/// The load that a sender puts on a link. Times are in ns.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LinkFigures {
    /// The bytes of the clip; bits are rounded up once.
    pub bytes: u64,
    /// The bytes per second over the clip, rounded to the nearest.
    pub bytes_per_second: u64,
    /// The rates in windows of 1, 10 and 100 ms.
    pub windows: [WindowRates; 3],
    /// The bytes of the largest frame.
    pub largest_frame_bytes: u64,
    /// The longest time from reading the oldest pixel of a unit to its decision.
    pub decision_ns: u64,
    /// The times from reading the oldest pixel of a unit to its last bit at the other end of the
    /// link.
    pub delivery_ns: DeliveryTimes,
    /// The size in bytes of the buffer in front of the link that loses nothing of this clip.
    pub buffer_bytes: u64,
    /// True if the clip needs more than the link carries, so that the buffer grows with the length
    /// of the clip.
    pub overloaded: bool,
}

/// The delivery times over the units of a sender, in ns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DeliveryTimes {
    /// The median (nearest rank).
    pub median: u64,
    /// The time that 99 of 100 units do not exceed (nearest rank).
    pub p99: u64,
    /// The longest time.
    pub longest: u64,
}

impl LinkFigures {
    /// Computes the figures of units, in any order, over a link of `rate` bits per second.
    #[must_use]
    pub fn from_units(mut units: Vec<LinkUnit>, timeline: &Timeline, rate: u64) -> Self {
        units.sort_by_key(|unit| (unit.sent_ns, unit.frame, unit.read_ns));
        let served = send_over_link(&units, rate);
        let bits: u64 = units.iter().map(|unit| unit.bits).sum();
        let mut frames = vec![0_u64; units.iter().map(frame_index).max().unwrap_or(0) + 1];
        units.iter().for_each(|unit| frames[frame_index(unit)] += unit.bits);
        let waits = units.iter().zip(&served.finished_ns);
        let mut waits: Vec<u64> = waits.map(|(unit, finished)| finished - unit.read_ns).collect();
        waits.sort_unstable();
        let rank = |percent| nearest_rank(&waits, percent);
        let decisions = units.iter().map(|unit| unit.decided_ns - unit.read_ns);
        let span = (0, timeline.end_ns());
        Self {
            bytes: bits.div_ceil(8),
            bytes_per_second: bytes_per_second(bits, timeline.end_ns()),
            windows: WINDOWS_MS.map(|window| WindowRates::from_units(&units, span, window)),
            largest_frame_bytes: frames.into_iter().max().unwrap_or(0).div_ceil(8),
            decision_ns: decisions.max().unwrap_or(0),
            delivery_ns: DeliveryTimes { median: rank(50), p99: rank(99), longest: rank(100) },
            buffer_bytes: served.backlog_bits.div_ceil(8),
            overloaded: is_overloaded(bits, timeline.end_ns(), rate),
        }
    }
}

fn frame_index(unit: &LinkUnit) -> usize {
    usize::try_from(unit.frame).expect("frames are in memory")
}

/// Returns the rate in bytes per second, rounded to the nearest.
pub(crate) fn bytes_per_second(bits: u64, duration_ns: u64) -> u64 {
    let duration = 8 * u128::from(duration_ns.max(1));
    let rate = (u128::from(bits) * 1_000_000_000 + duration / 2) / duration;
    u64::try_from(rate).unwrap_or(u64::MAX)
}

fn is_overloaded(bits: u64, duration_ns: u64, rate: u64) -> bool {
    u128::from(bits) * 1_000_000_000 > u128::from(rate) * u128::from(duration_ns)
}
