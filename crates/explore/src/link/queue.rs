// SPDX-License-Identifier: MIT OR Apache-2.0
//! A link with one rate behind a buffer that loses nothing, in integers. Bits leave in the order in
//! which they came, one after the other, at the rate of the link. Framing and the length of the
//! link take no time.

use crate::link::LinkUnit;

/// The number of nanoseconds of a second.
const NS_PER_SECOND: u128 = 1_000_000_000;

/// The result of sending some units over a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct QueueResult {
    /// The time at which the last bit of every unit has left, in ns, rounded up; in the order of
    /// the units.
    pub finished_ns: Vec<u64>,
    /// The most bits that wait or are on the link at a time, rounded up.
    pub backlog_bits: u64,
}

/// Sends units over a link of `rate` bits per second.
///
/// # Panics
/// Panics if the units are not sorted by the time at which they are sent, or if the rate is 0.
#[must_use]
pub fn send_over_link(units: &[LinkUnit], rate: u64) -> QueueResult {
    assert!(units.is_sorted_by_key(|unit| unit.sent_ns), "a queue is served in the order of time");
    assert!(rate > 0, "a link has a rate");
    // In steps of a nanosecond divided by the rate, a bit takes a whole number of steps.
    let (mut free, mut backlog) = (0, 0);
    let finished = units.iter().map(|unit| {
        let sent = u128::from(unit.sent_ns) * u128::from(rate);
        free = free.max(sent) + u128::from(unit.bits) * NS_PER_SECOND;
        backlog = backlog.max(free - sent);
        narrow(free.div_ceil(u128::from(rate)))
    });
    let finished = finished.collect();
    QueueResult { finished_ns: finished, backlog_bits: narrow(backlog.div_ceil(NS_PER_SECOND)) }
}

fn narrow(value: u128) -> u64 {
    u64::try_from(value).unwrap_or(u64::MAX)
}
