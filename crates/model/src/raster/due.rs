// SPDX-License-Identifier: MIT OR Apache-2.0
//! What comes a fixed number of clocks after something else: a queue with the edges at which each is due.

use std::collections::VecDeque;

/// Things with their edges, which rise.
pub(super) type Due<T> = VecDeque<(u64, T)>;

/// Takes what is due at edge `now`.
pub(super) fn take_due<T>(queue: &mut Due<T>, now: u64) -> Option<T> {
    let is_due = queue.front().is_some_and(|(due, _)| *due == now);
    is_due.then(|| queue.pop_front()).flatten().map(|(_, thing)| thing)
}
