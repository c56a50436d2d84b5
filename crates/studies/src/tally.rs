// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sums over the frames of a clip.

use crate::number::count;
use crate::watch::Seen;

/// The numbers of regions in one frame, or in many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Regions {
    pub(crate) all: u64,
    pub(crate) srs: u64,
    pub(crate) trs: u64,
    pub(crate) active: u64,
}

impl Regions {
    pub(crate) fn of(seen: &Seen<'_>) -> Self {
        let outcome = seen.outcome;
        Self {
            all: outcome.srs.len() as u64,
            srs: count(&outcome.srs),
            trs: count(&outcome.trs),
            active: count(&outcome.active),
        }
    }
}

/// The sums over a whole clip or data set. Frame 0 of a clip has no reference, so all its regions
/// count as changed. It counts only in a clip without other frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RegionTally {
    sum: Regions,
    without_reference: Regions,
    /// The smallest and the largest number of active regions of a frame.
    extremes: Option<(u64, u64)>,
}

impl RegionTally {
    pub(crate) fn add(&mut self, seen: &Seen<'_>) {
        let frame = Regions::of(seen);
        if seen.without_reference {
            self.without_reference = frame;
            return;
        }
        self.sum.all += frame.all;
        self.sum.srs += frame.srs;
        self.sum.trs += frame.trs;
        self.sum.active += frame.active;
        let (min, max) = self.extremes.unwrap_or((frame.active, frame.active));
        self.extremes = Some((min.min(frame.active), max.max(frame.active)));
    }

    pub(crate) fn sum(&self) -> Regions {
        if self.extremes.is_some() { self.sum } else { self.without_reference }
    }

    pub(crate) fn extremes(&self) -> (u64, u64) {
        let only = self.without_reference.active;
        self.extremes.unwrap_or((only, only))
    }
}
