// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a recording: each has a reset, some frames, a pattern of gaps, and the state in
//! which the next reset finds the core.

mod pipelined;
mod raster;
mod serial;

use super::faulty_store::StoreFault;
use super::random::Random;
use super::stimulus_pattern::StimulusPattern;
use super::threshold_aimer::ThresholdAim;
use foveate_design::{Design, Hardware};

/// A sequence of frames with one property in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameSequence {
    /// The name of the sequence in reports.
    pub(super) name: &'static str,
    /// The patterns of the regions, frame by frame.
    pub(super) patterns: &'static [StimulusPattern],
    /// True if every region starts at another pattern.
    pub(super) is_mixed: bool,
    /// The state of the core at the end of the sequence.
    pub(super) end: SequenceEnd,
    /// The choice of thresholds.
    pub(super) aim: ThresholdAim,
    /// True if the sink stalls so long that regions are lost.
    pub(super) sink_stalls: bool,
    /// The fault of the external frame store, if there is one.
    pub(super) store_fault: StoreFault,
}

/// The state at which the reset of the next sequence comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SequenceEnd {
    /// Some clocks after all pixels have left.
    Drained,
    /// Between the beats of a frame, up to the given number of clocks after one.
    Loading(u64),
    /// Up to the given number of clocks after the last beat of a frame.
    Flushing(u64),
    /// The clock at which the lanes begin with a frame, or soon after it.
    LanesStarted,
    /// Any clock of the work on a frame, or, about every second time, the clock before the first
    /// score is at the ports. `first_score` is the number of clocks from that score until the core
    /// is ready.
    Working { first_score: u64 },
    /// Up to the given number of clocks after the first score.
    Rotating(u64),
    /// Up to the given number of clocks before the core is ready.
    Finishing(u64),
    /// Up to the given number of clocks after the first pixel that leaves.
    Leaving(u64),
    /// The edge at which a region would be lost in the middle, if there is one.
    BeforeLoss,
}

impl FrameSequence {
    /// A sequence whose regions show different patterns, with thresholds that meet them exactly; at
    /// the end everything leaves.
    const fn with_exact_thresholds(name: &'static str, motifs: &'static [StimulusPattern]) -> Self {
        Self::with_aim(ThresholdAim::Exact, name, motifs)
    }

    /// A sequence like that of `mixed`, with another choice of thresholds.
    const fn with_aim(
        aim: ThresholdAim,
        name: &'static str,
        motifs: &'static [StimulusPattern],
    ) -> Self {
        Self {
            name,
            patterns: motifs,
            is_mixed: true,
            end: SequenceEnd::Drained,
            aim,
            sink_stalls: false,
            store_fault: StoreFault::None,
        }
    }

    /// A sequence with as many relevant regions as possible, which ends at `end`.
    const fn ending_at(
        name: &'static str,
        motifs: &'static [StimulusPattern],
        end: SequenceEnd,
    ) -> Self {
        Self { end, ..Self::with_aim(ThresholdAim::Smallest, name, motifs) }
    }
}

/// Returns sequences in which every region shows a summary, the same one behind a reset, pixels,
/// and that summary again.
const fn mean_sequences_around_reset() -> [FrameSequence; 2] {
    use StimulusPattern::{Noise, Same, Zero};
    let aimed = FrameSequence::with_aim;
    [
        FrameSequence {
            is_mixed: false,
            ..aimed(ThresholdAim::Independent, "means before a reset", &[Noise, Zero, Zero])
        },
        FrameSequence {
            is_mixed: false,
            ..aimed(
                ThresholdAim::Independent,
                "means behind a reset",
                &[Zero, Noise, Zero, Same, Noise],
            )
        },
    ]
}

/// Returns all sequences of a design, the most telling first.
pub(super) fn sequences(design: &Design) -> Vec<FrameSequence> {
    match design.hardware() {
        Hardware::Pipelined(own) => pipelined::sequences(design.with_hardware(own)),
        Hardware::Serial(own) => serial::sequences(design.with_hardware(own)),
        Hardware::Raster(own) => raster::sequences(design.with_hardware(own)),
    }
}

/// The pattern of pauses between pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GapPattern {
    /// A pixel comes at every clock, and frames follow at once.
    None,
    /// Pauses are random, and most frames follow at once.
    Random,
    /// Pixels come in bursts, with pauses of many clocks; frames are often far enough apart for a
    /// flush.
    Bursts,
}

impl GapPattern {
    pub(super) const ALL: [Self; 3] = [Self::None, Self::Random, Self::Bursts];

    /// Returns the number of clocks without a pixel before the next one.
    pub(super) fn before_pixel(self, random: &mut Random) -> u64 {
        match self {
            Self::None => 0,
            Self::Random if random.one_in(3) => 1 + random.up_to(2),
            Self::Bursts if random.one_in(40) => 1 + random.up_to(30),
            Self::Random | Self::Bursts => 0,
        }
    }

    /// Returns the number of clocks without a pixel between two frames; after `settle` clocks
    /// everything has settled.
    pub(super) fn between_frames(self, settle: u64, random: &mut Random) -> u64 {
        match self {
            Self::None => 0,
            Self::Random => match random.up_to(3) {
                0 => 1,
                1 => random.up_to(settle),
                _ => 0,
            },
            Self::Bursts => match random.up_to(2) {
                0 => 0,
                1 => random.up_to(settle),
                _ => settle,
            },
        }
    }
}
