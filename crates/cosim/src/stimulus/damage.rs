// SPDX-License-Identifier: MIT OR Apache-2.0
//! Streams that are damaged on their way, for designs that find their frames again: what comes of each frame, and
//! where the next reset finds the core.

use self::Delivery::{Long, Restarted, Short, Strays, Twice, Unmarked, Whole};
use self::Part::{AllButOne, One, Some as Many};
use super::random::Random;

/// What comes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Delivery {
    /// All of it, its first beat marked as that.
    Whole,
    /// All but its last beats.
    Short(Part),
    /// All of it, and beats of no frame behind it.
    Long(Part),
    /// All of it, with its first beat twice, both of them marked.
    Twice,
    /// All of it, with another beat marked, too.
    Restarted,
    /// All of it, without a mark.
    Unmarked,
    /// A few beats of no frame in place of it.
    Strays,
}

/// How many beats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    One,
    Some,
    AllButOne,
}

/// A sequence of such frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct Damaged {
    /// Its name in reports.
    pub(super) name: &'static str,
    pub(super) deliveries: &'static [Delivery],
    pub(super) stop: Stop,
}

/// Where the reset that begins the next sequence comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stop {
    /// After everything has left.
    Drained,
    /// As soon as the last beat has been taken.
    AtOnce,
    /// While the core completes a frame by itself.
    Filling,
}

/// A sequence of any kind.
pub(super) enum Directed<Sequence> {
    /// Of whole frames.
    Usual(Sequence),
    /// Of damaged ones.
    Damaged(&'static Damaged),
}

/// The usual sequences, and those of damaged streams behind them if the simulated hardware finds its frames.
pub(super) fn directed<Sequence: Copy>(
    usual: &[Sequence],
    finds_frames: bool,
) -> Vec<Directed<Sequence>> {
    let damaged = if finds_frames { DAMAGED } else { &[] };
    let usual = usual.iter().copied().map(Directed::Usual);
    usual.chain(damaged.iter().map(Directed::Damaged)).collect()
}

const fn drained(name: &'static str, deliveries: &'static [Delivery]) -> Damaged {
    Damaged { name, deliveries, stop: Stop::Drained }
}

/// Every sequence, the most telling first.
const DAMAGED: &[Damaged] = &[
    drained("a beat lost", &[Whole, Whole, Short(One), Whole, Whole, Whole]),
    // Marks that come while the core completes a frame are none.
    drained(
        "marks while it completes",
        &[Short(AllButOne), Short(AllButOne), Short(AllButOne), Whole, Whole, Whole],
    ),
    Damaged {
        name: "reset while it completes",
        deliveries: &[Whole, Short(AllButOne)],
        stop: Stop::Filling,
    },
    drained("the first frame damaged", &[Short(Many), Whole, Whole, Whole]),
    // What comes after this reset begins with a beat that would be an error without it.
    Damaged { name: "reset before a start", deliveries: &[Whole, Whole], stop: Stop::AtOnce },
    drained("beats before the first frame", &[Strays, Whole, Whole, Short(Many), Whole, Whole]),
    Damaged { name: "reset in a frame", deliveries: &[Whole, Short(Many)], stop: Stop::AtOnce },
    drained("beats too many", &[Whole, Long(One), Whole, Long(Many), Whole]),
    Damaged { name: "reset while it seeks", deliveries: &[Whole, Strays], stop: Stop::AtOnce },
    drained("begun twice", &[Twice, Whole, Restarted, Whole, Whole]),
    drained("all but one lost", &[Whole, Short(AllButOne), Whole, Whole]),
    Damaged { name: "reset after a frame", deliveries: &[Whole], stop: Stop::AtOnce },
    drained("no mark", &[Unmarked, Whole, Unmarked, Whole, Unmarked, Strays, Whole]),
    drained("damaged again and again", &[Short(One), Short(Many), Short(Many), Whole, Whole]),
];

impl Delivery {
    /// The first beat of a frame, and no more.
    pub(super) const FIRST: Self = Short(AllButOne);

    /// The beats that come of a frame of `count`: whether each is marked, and which beat of the frame it is; none
    /// for one of no frame.
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
                whole(count).chain(strays(more)).collect()
            }
            Twice => std::iter::once((true, Some(0))).chain(whole(count)).collect(),
            Restarted => {
                let again = any(count - 1);
                whole(count).map(|(sof, place)| (sof || place == Some(again), place)).collect()
            }
            Unmarked => whole(count).map(|(_, place)| (false, place)).collect(),
            Strays => strays(any(count.min(9) - 1)).collect(),
        }
    }
}

fn strays(count: usize) -> impl Iterator<Item = (bool, Option<usize>)> {
    std::iter::repeat_n((false, None), count)
}
