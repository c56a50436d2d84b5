// SPDX-License-Identifier: MIT OR Apache-2.0
//! The damage of frames for hardware that synchronizes to the start of a frame.

use self::BeatCount::{AllButOne, One, Some as Many};
use self::FrameDelivery::{Long, Restarted, Short, Strays, Twice, Unmarked, Whole};
use super::random::Random;

/// The damage of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FrameDelivery {
    /// The whole frame, with its first beat marked.
    Whole,
    /// The frame without its last beats.
    Short(BeatCount),
    /// The whole frame, followed by beats of no frame.
    Long(BeatCount),
    /// The whole frame with its first beat twice, both of them marked.
    Twice,
    /// The whole frame, with a second beat marked, too.
    Restarted,
    /// The whole frame without a mark.
    Unmarked,
    /// A few beats of no frame, in place of the frame.
    Strays,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BeatCount {
    One,
    Some,
    AllButOne,
}

impl FrameDelivery {
    /// A frame without its last beat.
    pub(crate) const ONE_BEAT_SHORT: Self = Short(One);
    /// A frame with one beat too many.
    pub(crate) const ONE_BEAT_LONG: Self = Long(One);

    /// Returns the beats of a frame of `count` beats: each with its start mark, and its index in
    /// the frame or `None` for a beat of no frame.
    pub(super) fn beats(self, count: usize, random: &mut Random) -> Vec<(bool, Option<usize>)> {
        let whole = |count: usize| (0..count).map(|place| (place == 0, Some(place)));
        let mut any = |most: usize| 1 + random.index(most - 1);
        let mut part = |part| match part {
            One => 1,
            Many => any(count - 1),
            AllButOne => count - 1,
        };
        match self {
            Whole => whole(count).collect(),
            Short(missing) => whole(count - part(missing)).collect(),
            Long(more) => {
                let more = part(more);
                whole(count).chain(stray_beats(more)).collect()
            }
            Twice => std::iter::once((true, Some(0))).chain(whole(count)).collect(),
            Restarted => {
                let again = any(count - 1);
                whole(count).map(|(sof, place)| (sof || place == Some(again), place)).collect()
            }
            Unmarked => whole(count).map(|(_, place)| (false, place)).collect(),
            Strays => stray_beats(any(count.min(9) - 1)).collect(),
        }
    }
}

fn stray_beats(count: usize) -> impl Iterator<Item = (bool, Option<usize>)> {
    std::iter::repeat_n((false, None), count)
}
