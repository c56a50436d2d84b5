// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a raster core.

use super::super::sequence_end::SequenceEnd;
use super::super::stimulus_pattern::StimulusPattern::*;
use super::{CHECKERBOARD, FrameSequence, mean_sequences_around_reset};
use crate::stimulus::sink::StoreFault;
use crate::stimulus::threshold_ranges::ThresholdAim;
use foveate_design::{RasterDesign, RasterTiming};

/// Returns all sequences, the most telling first. Sequences that end with a reset within a frame
/// alternate with the others, so that the remaining state meets another kind of frame each time.
pub(super) fn sequences(design: RasterDesign<'_>) -> Vec<FrameSequence> {
    let (mixed, aimed, cut) =
        (FrameSequence::with_exact_thresholds, FrameSequence::with_aim, FrameSequence::ending_at);
    let loading = SequenceEnd::Loading(2);
    let timing = RasterTiming::from_design(design);
    let flushing = SequenceEnd::Flushing(timing.edges_to_ready());
    let leaving = SequenceEnd::Leaving(2 * u64::from(timing.region_words));
    let mut sequences = vec![
        FrameSequence {
            is_mixed: false,
            ..mixed("extremes", &[Max, Zero, CHECKERBOARD, TwoPoint])
        },
        cut("reset while loading", &[Noise, Ramp], loading),
        FrameSequence {
            sink_stalls: true,
            ..cut("losses", &[Noise, Same, Binary, Same, Same, Noise], SequenceEnd::Drained)
        },
        cut("reset in the flush", &[Noise, Binary], flushing),
        mixed("steps", &[Step, Ring, HotCorner, Ramp]),
        FrameSequence {
            sink_stalls: true,
            ..cut("reset after losses", &[Noise, Max, Binary], leaving)
        },
        FrameSequence {
            sink_stalls: true,
            ..cut("reset at a loss", &[Noise, Binary, Max], SequenceEnd::BeforeLoss)
        },
        mixed("changes", &[Smooth, Bump, LightStep, Same, Bump]),
        cut("reset while pixels leave", &[Noise], leaving),
        aimed(ThresholdAim::Configured, "configured", &[Smooth, Bump, Ramp, Flat, Same]),
        cut("reset after one frame", &[TwoPoint], flushing),
        aimed(
            ThresholdAim::Smallest,
            "blanked",
            &[Noise, Same, Zero, Zero, Noise, Same, MovingPixel],
        ),
        FrameSequence {
            sink_stalls: true,
            ..aimed(
                ThresholdAim::Smallest,
                "blanked and lost",
                &[Noise, Zero, Noise, Same, Zero, Noise, Same],
            )
        },
        mixed("halves", &[HalfMean, TwoPoint, HalfMean]),
        mixed("fades", &[Smooth, Flicker, Fade, Fade, MovingPixel]),
        FrameSequence {
            is_mixed: false,
            ..aimed(
                ThresholdAim::Largest,
                "largest",
                &[Quadrant, Quadrant, Quadrant, Quadrant, Quadrant],
            )
        },
    ];
    if design.periphery().is_some() {
        sequences.extend(mean_sequences());
        // All regions send means, and one mean is on the ports; a reset must follow.
        sequences.push(FrameSequence {
            is_mixed: false,
            end: SequenceEnd::Leaving(0),
            ..aimed(ThresholdAim::Independent, "reset while means leave", &[Zero])
        });
        sequences.extend(mean_sequences_around_reset());
    }
    if design.has_external_store() {
        sequences.extend(store_fault_sequences(flushing));
    }
    sequences
}

/// Returns sequences with means that meet the level or miss it by one, means that are lost, means
/// that stay on the screen while their region is held, and means that leave beside relevant regions
/// which drift away from what was last sent.
fn mean_sequences() -> [FrameSequence; 6] {
    let (mixed, aimed) = (FrameSequence::with_exact_thresholds, FrameSequence::with_aim);
    let configured = ThresholdAim::Configured;
    [
        aimed(configured, "means", &[Flat, MeanStep, MeanStep, MeanStep, MeanStep, MeanStep]),
        FrameSequence {
            sink_stalls: true,
            ..aimed(configured, "means lost", &[Flat, MeanStep, Same, Step, Same, MeanStep, Flat])
        },
        aimed(configured, "means kept", &[Flat, Step, Flat, MeanStep, Ramp, Same, MeanStep]),
        mixed("means of anything", &[Smooth, LightStep, Binary, MeanStep, Flicker, Noise]),
        aimed(
            ThresholdAim::HeldRegions,
            "means held",
            &[Noise, Same, Same, MeanStep, Same, MeanStep],
        ),
        FrameSequence {
            is_mixed: false,
            ..aimed(
                ThresholdAim::DriftingRegions,
                "means beside pixels",
                &[Step, Fade, Fade, Step, Fade, Fade, HotCorner, Fade, Fade],
            )
        },
    ]
}

/// Returns the sequences with a faulty external frame store.
fn store_fault_sequences(flushing: SequenceEnd) -> [FrameSequence; 7] {
    let (mixed, aimed, cut) =
        (FrameSequence::with_exact_thresholds, FrameSequence::with_aim, FrameSequence::ending_at);
    let loading = SequenceEnd::Loading(2);
    [
        FrameSequence {
            store_fault: StoreFault::Late,
            ..mixed("late references", &[Smooth, Bump, Same, Noise, Same])
        },
        FrameSequence {
            store_fault: StoreFault::Late,
            ..cut("reset after an underrun", &[Noise, Binary, Ramp, Noise], loading)
        },
        FrameSequence {
            store_fault: StoreFault::Missing,
            ..aimed(ThresholdAim::Smallest, "lost references", &[Noise, Same, Same, Noise])
        },
        cut("reset while references come", &[Noise, Same, Same], loading),
        FrameSequence {
            store_fault: StoreFault::Wrong,
            ..mixed("wrong references", &[Ramp, Same, Same, Noise, Same])
        },
        FrameSequence {
            store_fault: StoreFault::Wrong,
            is_mixed: false,
            ..aimed(
                ThresholdAim::Configured,
                "wrong references of extremes",
                &[Max, Max, Zero, Zero],
            )
        },
        cut("reset after wrong references", &[Smooth, Same], flushing),
    ]
}
