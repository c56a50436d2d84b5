// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parts of every clip that a fit uses, and the frames that a network sees.

use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClipPart {
    /// The first two thirds of the first half, which cameras are searched by.
    Search,
    /// The rest of the first half, which comes later, has no part in the search, and confirms its
    /// result.
    Confirmation,
    /// The second half.
    HeldOut,
}

impl ClipPart {
    /// All parts, in the order of their frames.
    pub(super) const ALL: [Self; 3] = [Self::Search, Self::Confirmation, Self::HeldOut];

    /// The fewest frames of a clip with which each part has a frame.
    pub(super) const MIN_FRAMES: u64 = 6;

    /// Returns the frames of this part of a clip with `all` frames, of which `half` are the first
    /// half.
    pub(super) fn frames(self, (half, all): (u64, u64)) -> Range<u64> {
        let searched = (2 * half).div_ceil(3);
        match self {
            Self::Search => 0..searched,
            Self::Confirmation => searched..half,
            Self::HeldOut => half..all,
        }
    }

    /// Returns the frames without the first one of the clip, which every camera sends whole.
    pub(super) fn later_frames(self, halves: (u64, u64)) -> Range<u64> {
        let Range { start, end } = self.frames(halves);
        start.max(1)..end
    }
}

pub(super) fn spread_evenly(range: Range<u64>, most: u64) -> Vec<u64> {
    let length = range.end.saturating_sub(range.start);
    let count = most.min(length);
    (0..count).map(|index| range.start + (2 * index + 1) * length / (2 * count)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every frame but the first is in one part, the confirming frames come after those of the
    /// search, and no part is empty.
    #[test]
    fn parts_follow_each_other() {
        for all in ClipPart::MIN_FRAMES..200 {
            let [searched, confirmed, held_out] =
                ClipPart::ALL.map(|part| part.later_frames((all / 2, all)));
            let ends = (searched.start, held_out.end);
            assert_eq!(
                (ends, searched.end, confirmed.end),
                ((1, all), confirmed.start, held_out.start)
            );
            assert!(!searched.is_empty() && !confirmed.is_empty() && !held_out.is_empty(), "{all}");
        }
        assert_eq!(ClipPart::Confirmation.frames((90, 180)), 60..90);
        let one_fewer = ClipPart::MIN_FRAMES - 1;
        assert!(ClipPart::Confirmation.frames((one_fewer / 2, one_fewer)).is_empty());
    }

    #[test]
    fn frames_are_spread_evenly() {
        assert_eq!(spread_evenly(1..5, 10), [1, 2, 3, 4]);
        assert_eq!(spread_evenly(0..100, 4), [12, 37, 62, 87]);
        assert_eq!(spread_evenly(50..60, 1), [55]);
        assert!(spread_evenly(1..1, 4).is_empty());
    }
}
