// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a bench does to a stream whose frames are found again: an error of each kind, and whole frames behind it.

/// Frames that are delivered.
pub(super) const DAMAGED: usize = Delivery::ALL.len();

/// What comes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Delivery {
    /// Its last beat alone, which is no first one.
    Stray,
    /// All of it.
    Whole,
    /// All but its last beats.
    Short,
    /// All of it, and a beat of no frame.
    Long,
}

/// Beats that a short frame lacks.
const LACKED: usize = 3;

impl Delivery {
    /// Frame by frame. The one behind the short one comes too early, and is dropped.
    pub(super) const ALL: [Self; 6] =
        [Self::Stray, Self::Whole, Self::Short, Self::Whole, Self::Long, Self::Whole];

    /// The beats that come, and whether each is marked as the first of a frame.
    pub(super) fn of<'a>(self, beats: &'a [Vec<u16>], stray: &'a [u16]) -> Vec<(bool, &'a [u16])> {
        let count = beats.len();
        let (from, to) = match self {
            Self::Stray => (count.saturating_sub(1), count),
            Self::Whole | Self::Long => (0, count),
            Self::Short => (0, count.saturating_sub(LACKED).max(1)),
        };
        let own = (from..to).map(|number| (number == 0, beats[number].as_slice()));
        let more = (self == Self::Long).then_some((false, stray));
        own.chain(more).collect()
    }
}
