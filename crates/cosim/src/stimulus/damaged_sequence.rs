// SPDX-License-Identifier: MIT OR Apache-2.0
//! Damaged streams of frames for designs with `sync`: the damage of each frame, and the state in
//! which the next reset finds the core.

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

/// A number of beats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BeatCount {
    One,
    Some,
    AllButOne,
}

/// A sequence of damaged and whole frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct DamagedSequence {
    /// The name of the sequence in reports.
    pub(super) name: &'static str,
    pub(super) deliveries: &'static [FrameDelivery],
    pub(super) end: DamagedSequenceEnd,
}

/// The state at which the reset of the next sequence comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DamagedSequenceEnd {
    /// The reset comes after everything has left.
    Drained,
    /// The reset comes as soon as the last beat has been taken.
    AfterLastBeat,
    /// The reset comes while the core completes a frame by itself.
    Filling,
}

/// A sequence of either type.
pub(super) enum DirectedSequence<Sequence> {
    /// A sequence of whole frames.
    Usual(Sequence),
    /// A sequence of damaged frames.
    Damaged(&'static DamagedSequence),
}

/// Returns the usual sequences, followed by those of damaged frames if the simulated hardware
/// synchronizes to the start of a frame.
pub(super) fn directed_sequences<Sequence: Copy>(
    usual: &[Sequence],
    finds_frames: bool,
) -> Vec<DirectedSequence<Sequence>> {
    let damaged = if finds_frames { DAMAGED_SEQUENCES } else { &[] };
    let usual = usual.iter().copied().map(DirectedSequence::Usual);
    usual.chain(damaged.iter().map(DirectedSequence::Damaged)).collect()
}

const fn drained_sequence(
    name: &'static str,
    deliveries: &'static [FrameDelivery],
) -> DamagedSequence {
    DamagedSequence { name, deliveries, end: DamagedSequenceEnd::Drained }
}

/// All sequences of damaged frames, the most telling first.
const DAMAGED_SEQUENCES: &[DamagedSequence] = &[
    drained_sequence("a beat lost", &[Whole, Whole, Short(One), Whole, Whole, Whole]),
    // Start marks that come while the core completes a frame are ignored.
    drained_sequence(
        "marks while it completes",
        &[Short(AllButOne), Short(AllButOne), Short(AllButOne), Whole, Whole, Whole],
    ),
    DamagedSequence {
        name: "reset while it completes",
        deliveries: &[Whole, Short(AllButOne)],
        end: DamagedSequenceEnd::Filling,
    },
    drained_sequence("the first frame damaged", &[Short(Many), Whole, Whole, Whole]),
    // The sequence after this reset begins with a beat that would be an error without the reset.
    DamagedSequence {
        name: "reset before a start",
        deliveries: &[Whole, Whole],
        end: DamagedSequenceEnd::AfterLastBeat,
    },
    drained_sequence(
        "beats before the first frame",
        &[Strays, Whole, Whole, Short(Many), Whole, Whole],
    ),
    DamagedSequence {
        name: "reset in a frame",
        deliveries: &[Whole, Short(Many)],
        end: DamagedSequenceEnd::AfterLastBeat,
    },
    drained_sequence("beats too many", &[Whole, Long(One), Whole, Long(Many), Whole]),
    DamagedSequence {
        name: "reset while it seeks",
        deliveries: &[Whole, Strays],
        end: DamagedSequenceEnd::AfterLastBeat,
    },
    drained_sequence("begun twice", &[Twice, Whole, Restarted, Whole, Whole]),
    drained_sequence("all but one lost", &[Whole, Short(AllButOne), Whole, Whole]),
    DamagedSequence {
        name: "reset after a frame",
        deliveries: &[Whole],
        end: DamagedSequenceEnd::AfterLastBeat,
    },
    drained_sequence("no mark", &[Unmarked, Whole, Unmarked, Whole, Unmarked, Strays, Whole]),
    drained_sequence(
        "damaged again and again",
        &[Short(One), Short(Many), Short(Many), Whole, Whole],
    ),
];

impl FrameDelivery {
    /// The first beat of a frame alone.
    pub(super) const FIRST_BEAT: Self = Short(AllButOne);
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
