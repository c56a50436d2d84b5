// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a recording: each has a reset, some frames, a pattern of gaps, and the state in
//! which the next reset finds the core.

mod damaged;
mod pipelined;
mod raster;
mod serial;

use super::frame_feed::FrameDelivery;
use super::port_zones::ClassChoice;
use super::sequence_end::SequenceEnd;
use super::sink::StoreFault;
use super::stimulus_pattern::{StimulusPattern, Texture};
use super::threshold_ranges::ThresholdAim;
use foveate_camera::FeatureKind;
use foveate_design::{Design, Hardware};

const CHECKERBOARD: StimulusPattern = StimulusPattern::Texture(Texture::Checkers(1));

/// A sequence of frames with one property in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameSequence {
    /// The name of the sequence in reports.
    pub(super) name: &'static str,
    /// The patterns of the regions, frame by frame.
    pub(super) patterns: &'static [StimulusPattern],
    /// The damage of each frame. If it is empty, all frames are whole, one for each pattern.
    pub(super) deliveries: &'static [FrameDelivery],
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
    /// The classes of the regions, in a core with zones.
    pub(super) classes: ClassChoice,
}

impl FrameSequence {
    pub(super) fn frame_count(&self) -> usize {
        if self.deliveries.is_empty() { self.patterns.len() } else { self.deliveries.len() }
    }

    /// A sequence whose regions show different patterns, with thresholds that meet them exactly; at
    /// the end everything leaves.
    const fn with_exact_thresholds(
        name: &'static str,
        patterns: &'static [StimulusPattern],
    ) -> Self {
        Self::with_aim(ThresholdAim::Exact, name, patterns)
    }

    /// A sequence like that of `mixed`, with another choice of thresholds.
    const fn with_aim(
        aim: ThresholdAim,
        name: &'static str,
        patterns: &'static [StimulusPattern],
    ) -> Self {
        Self {
            name,
            patterns,
            deliveries: &[],
            is_mixed: true,
            end: SequenceEnd::Drained,
            aim,
            sink_stalls: false,
            store_fault: StoreFault::None,
            classes: aim.classes(),
        }
    }

    /// A sequence with as many relevant regions as possible, which ends at `end`.
    const fn ending_at(
        name: &'static str,
        patterns: &'static [StimulusPattern],
        end: SequenceEnd,
    ) -> Self {
        Self { end, ..Self::with_aim(ThresholdAim::Smallest, name, patterns) }
    }
}

/// Returns sequences in which every region shows a summary, another one, the same one behind a
/// reset, pixels, and that summary again.
const fn mean_sequences_around_reset() -> [FrameSequence; 2] {
    use StimulusPattern::{Max, Noise, Same, Zero};
    let aimed = FrameSequence::with_aim;
    [
        FrameSequence {
            is_mixed: false,
            ..aimed(ThresholdAim::Independent, "means before a reset", &[Noise, Max, Zero, Zero])
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

/// Returns sequences that bring about a situation whatever is drawn: every region is active,
/// irrelevant, active again, and held twice; all pixels of a region count as changed, and the
/// minimum is above that.
const fn certain_sequences() -> [FrameSequence; 2] {
    use StimulusPattern::{Noise, Same, Zero};
    let aimed = FrameSequence::with_aim;
    [
        FrameSequence {
            is_mixed: false,
            ..aimed(ThresholdAim::Independent, "sent again", &[Noise, Zero, Noise, Same, Same])
        },
        aimed(ThresholdAim::HeldRegions, "never changed enough", &[Noise]),
    ]
}

/// Returns a sequence in which the score of `surface` is large. In regions of 8x8, 16x16 and 32x32
/// pixels it reaches its highest bit, if no filter smooths the pixels.
const fn rough_sequence() -> FrameSequence {
    use StimulusPattern::{Same, Zero};
    const MOSAIC: StimulusPattern = StimulusPattern::Texture(Texture::Mosaic);
    let patterns = &[MOSAIC, Zero, MOSAIC, Same];
    let rough = FrameSequence::with_aim(ThresholdAim::Independent, "rough surface", patterns);
    FrameSequence { is_mixed: false, ..rough }
}

/// Returns a sequence in which the regions have the classes of the configuration, from the second
/// bank of the memory of classes, into which nothing has been written.
const fn first_map_sequence() -> FrameSequence {
    use StimulusPattern::{Noise, Zero};
    let patterns = &[Noise, Zero, Noise];
    let first = FrameSequence::with_aim(ThresholdAim::Smallest, "first map of classes", patterns);
    FrameSequence { is_mixed: false, classes: ClassChoice::Configured, ..first }
}

/// Returns all sequences of a design, the most telling first. Sequences of damaged frames are
/// behind the others, if the simulated hardware synchronizes to the start of a frame.
pub(super) fn sequences(design: &Design, has_frame_sync: bool) -> Vec<FrameSequence> {
    let mut sequences = match design.hardware() {
        Hardware::Pipelined(own) => pipelined::sequences(design.with_hardware(own)),
        Hardware::Serial(own) => serial::sequences(design.with_hardware(own)),
        Hardware::Raster(own) => raster::sequences(design.with_hardware(own)),
    };
    if design.has_class_memory() {
        sequences.insert(0, first_map_sequence());
    }
    sequences.extend(certain_sequences());
    if design.feature_kinds().contains(&FeatureKind::Surface) {
        sequences.push(rough_sequence());
    }
    if has_frame_sync {
        sequences.extend(damaged::sequences());
    }
    sequences
}
