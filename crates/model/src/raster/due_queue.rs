// SPDX-License-Identifier: MIT OR Apache-2.0
//! A queue of events that follow others after a fixed number of clocks, with the edges at which
//! they are due.

use std::collections::VecDeque;

/// A queue of items with the edges at which they are due, in ascending order.
pub(super) type DueQueue<T> = VecDeque<(u64, T)>;

/// Removes and returns the item that is due at edge `now`, or returns `None`.
pub(super) fn take_due<T>(queue: &mut DueQueue<T>, now: u64) -> Option<T> {
    queue.front().filter(|(due, _)| *due == now)?;
    queue.pop_front().map(|(_, item)| item)
}
