// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sums over the frames of a clip in studies ([`RegionTally`]).

use crate::studies::number::count_votes;
use crate::studies::runner::FrameResult;

/// The numbers of regions in one frame, or in many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RegionCounts {
    pub(crate) all: u64,
    pub(crate) srs: u64,
    pub(crate) trs: u64,
    pub(crate) active: u64,
}

impl RegionCounts {
    pub(crate) fn of_frame(seen: &FrameResult<'_>) -> Self {
        let outcome = seen.outcome;
        Self {
            all: outcome.srs.len() as u64,
            srs: count_votes(&outcome.srs),
            trs: count_votes(&outcome.trs),
            active: count_votes(&outcome.active),
        }
    }
}

/// The sums over a whole clip or data set. Frame 0 of a clip has no reference, so all its regions
/// count as changed. It counts only in a clip without other frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RegionTally {
    sum: RegionCounts,
    without_reference: RegionCounts,
    /// The smallest and the largest number of active regions of a frame.
    extremes: Option<(u64, u64)>,
}

impl RegionTally {
    pub(crate) fn add(&mut self, seen: &FrameResult<'_>) {
        let frame = RegionCounts::of_frame(seen);
        if seen.is_without_reference {
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

    pub(crate) fn sum(&self) -> RegionCounts {
        if self.extremes.is_some() { self.sum } else { self.without_reference }
    }

    pub(crate) fn extremes(&self) -> (u64, u64) {
        let only = self.without_reference.active;
        self.extremes.unwrap_or((only, only))
    }
}
