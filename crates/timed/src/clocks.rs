// SPDX-License-Identifier: MIT OR Apache-2.0
//! The edges at which the beats of a frame are taken.
//!
//! Each beat has a *place*: the edge at which it would be taken if the frame began at edge 0 and
//! the source never paused. A pause delays a beat and all that follow. So the edges of a frame are
//! the places plus a delay that only grows, at the few beats before which the source pauses.

use super::delivery::NEVER;

/// The edges of one frame, by places.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FrameClocks {
    /// The places from which on a delay applies, in ascending order. The first is 0.
    delays: Vec<(u64, u64)>,
}

impl FrameClocks {
    /// Makes the edges of a frame that the core can take from edge `open` on. `offers` are places
    /// and the first edges at which the source offers their beats.
    pub(crate) fn new(open: u64, offers: impl Iterator<Item = (u64, u64)>) -> Self {
        let mut delays = vec![(0, open)];
        for (place, clock) in offers {
            let &(last_place, last_delay) = delays.last().expect("the first delay is always there");
            let delay = clock.min(NEVER).saturating_sub(place);
            if delay > last_delay {
                if place == last_place {
                    delays.pop();
                }
                delays.push((place, delay));
            }
        }
        Self { delays }
    }

    pub(crate) fn edge(&self, place: u64) -> u64 {
        let after = self.delays.partition_point(|&(from, _)| from <= place);
        place + self.delays[after - 1].1
    }

    pub(crate) fn edges(&self, places: u64) -> impl Iterator<Item = u64> {
        let ends = self.delays[1..].iter().map(|&(from, _)| from).chain([places]);
        let runs = self.delays.iter().zip(ends);
        runs.flat_map(move |(&(from, delay), to)| (from..to.min(places)).map(move |at| at + delay))
    }
}
