// SPDX-License-Identifier: MIT OR Apache-2.0
//! The damage that a bench does to a stream of frames for hardware with `sync`: one error of each
//! kind, and whole frames behind it.

/// The number of frames that are delivered.
pub(super) const DELIVERED_FRAMES: usize = BenchDelivery::ALL.len();

/// The part of a frame that is delivered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BenchDelivery {
    /// Only the last beat, without a start mark.
    Stray,
    /// All beats.
    Whole,
    /// All but the last beats.
    Short,
    /// All beats, and one beat that belongs to no frame.
    Long,
}

/// The number of beats that a short frame lacks.
const MISSING_BEATS: usize = 3;

impl BenchDelivery {
    /// The delivery of each frame, in order. The frame behind the short one comes too early, and is
    /// dropped.
    pub(super) const ALL: [Self; 6] =
        [Self::Stray, Self::Whole, Self::Short, Self::Whole, Self::Long, Self::Whole];

    /// Returns the beats to deliver, each with its start-of-frame mark.
    pub(super) fn delivered_beats<'a>(
        self,
        beats: &'a [Vec<u16>],
        stray: &'a [u16],
    ) -> Vec<(bool, &'a [u16])> {
        let count = beats.len();
        let (from, to) = match self {
            Self::Stray => (count.saturating_sub(1), count),
            Self::Whole | Self::Long => (0, count),
            Self::Short => (0, count.saturating_sub(MISSING_BEATS).max(1)),
        };
        let own = (from..to).map(|number| (number == 0, beats[number].as_slice()));
        let more = (self == Self::Long).then_some((false, stray));
        own.chain(more).collect()
    }
}
