// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of damaged frames, for hardware that synchronizes to the start of a frame.

use super::super::sequence_end::SequenceEnd::{self, Drained, Flushing};
use super::super::stimulus_pattern::VARYING_PATTERNS;
use super::FrameSequence;
use crate::stimulus::frame_feed::BeatCount::{AllButOne, One, Some as Many};
use crate::stimulus::frame_feed::FrameDelivery::{
    self, Long, Restarted, Short, Strays, Twice, Unmarked, Whole,
};
use crate::stimulus::threshold_ranges::ThresholdAim;

/// The first beat of a frame alone.
const FIRST_BEAT: FrameDelivery = Short(AllButOne);
/// The reset comes as soon as the last beat has been taken.
const AFTER_LAST_BEAT: SequenceEnd = Flushing(1);
/// The reset comes while the core completes a frame by itself.
const FILLING: SequenceEnd = Flushing(2);

/// The names, deliveries and ends of the sequences, the most telling first.
const SEQUENCES: &[(&str, &[FrameDelivery], SequenceEnd)] = &[
    ("a beat lost", &[Whole, Whole, Short(One), Whole, Whole, Whole], Drained),
    // Start marks that come while the core completes a frame are ignored.
    (
        "marks while it completes",
        &[FIRST_BEAT, FIRST_BEAT, FIRST_BEAT, Whole, Whole, Whole],
        Drained,
    ),
    ("reset while it completes", &[Whole, FIRST_BEAT, FIRST_BEAT], FILLING),
    ("the first frame damaged", &[Short(Many), Whole, Whole, Whole], Drained),
    // The sequence after this reset begins with a beat that would be an error without the reset.
    ("reset before a start", &[Whole, Whole], AFTER_LAST_BEAT),
    ("beats before the first frame", &[Strays, Whole, Whole, Short(Many), Whole, Whole], Drained),
    ("reset in a frame", &[Whole, Short(Many)], AFTER_LAST_BEAT),
    ("beats too many", &[Whole, Long(One), Whole, Long(Many), Whole], Drained),
    ("reset while it seeks", &[Whole, Strays], AFTER_LAST_BEAT),
    ("begun twice", &[Twice, Whole, Restarted, Whole, Whole], Drained),
    ("all but one lost", &[Whole, FIRST_BEAT, Whole, Whole], Drained),
    ("reset after a frame", &[Whole], AFTER_LAST_BEAT),
    ("no mark", &[Unmarked, Whole, Unmarked, Whole, Unmarked, Strays, Whole], Drained),
    ("damaged again and again", &[Short(One), Short(Many), Short(Many), Whole, Whole], Drained),
];

/// Returns all sequences. The sink stalls in every second one.
pub(super) fn sequences() -> impl Iterator<Item = FrameSequence> {
    SEQUENCES.iter().enumerate().map(|(number, &(name, deliveries, end))| FrameSequence {
        deliveries,
        end,
        sink_stalls: number.is_multiple_of(2),
        ..FrameSequence::with_aim(ThresholdAim::Configured, name, VARYING_PATTERNS)
    })
}
