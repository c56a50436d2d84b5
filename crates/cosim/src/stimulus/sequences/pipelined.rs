// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a pipelined RPU, and of an array of them.

use super::super::sequence_end::SequenceEnd;
use super::super::stimulus_pattern::StimulusPattern::*;
use super::{CHECKERBOARD, FrameSequence, mean_sequences_around_reset};
use crate::stimulus::model_driver::settling_clocks;
use crate::stimulus::threshold_ranges::ThresholdAim;
use foveate_design::PipelinedDesign;

/// Returns all sequences, the most telling first.
pub(super) fn sequences(design: PipelinedDesign<'_>) -> Vec<FrameSequence> {
    let (mixed, aimed) = (FrameSequence::with_exact_thresholds, FrameSequence::with_aim);
    let flushing = SequenceEnd::Flushing(settling_clocks(design));
    // The reset comes at once, while most is under way.
    let loading = SequenceEnd::Loading(0);
    let cut = |end, sequence| FrameSequence { end, ..sequence };
    let configured = ThresholdAim::Configured;
    let mut list = vec![
        mixed("extremes", &[Max, Zero, Max, Max, CHECKERBOARD, TwoPoint]),
        mixed("noise", &[Noise, Noise, Binary, Noise]),
        aimed(configured, "configured", &[Smooth, Bump, Ramp, Bump, Flat, Same, Step, LightStep]),
        cut(loading, mixed("reset in a frame", &[Noise, Ramp, Noise])),
        mixed("steps", &[Step, Ring, Step, Ramp, Step]),
        cut(flushing, mixed("reset in a flush", &[Max, Binary])),
        mixed("changes", &[Smooth, Bump, Bump, LightStep, Bump, Same]),
        cut(flushing, aimed(configured, "reset after one frame", &[Ramp])),
        mixed("halves", &[HalfMean, TwoPoint, HalfMean, TwoPoint]),
        aimed(ThresholdAim::EveryClock, "restless", &[Noise, Smooth, Binary, Ramp]),
        mixed("blanked", &[Noise, Same, Zero, Zero, Noise, Flat, Same, Noise]),
        mixed("corners", &[HotCorner, Ring, HotCorner, Ring]),
        cut(loading, aimed(configured, "reset in a frame, full", &[Max, Max])),
        mixed("flicker", &[Smooth, Flicker, Flicker, Same]),
        mixed("fade", &[Binary, Fade, Fade, Fade]),
        mixed("moving pixel", &[Flat, MovingPixel, MovingPixel, MovingPixel]),
        aimed(
            ThresholdAim::Largest,
            "largest",
            &[Quadrant, Quadrant, Quadrant, Quadrant, Quadrant],
        ),
    ];
    if design.periphery().is_some() {
        // The changes of means meet the level or miss it by one. The regions are irrelevant, some
        // of them relevant in between.
        list.extend([
            aimed(
                configured,
                "means",
                &[Flat, MeanStep, MeanStep, MeanStep, MeanStep, MeanStep, MeanStep, MeanStep],
            ),
            mixed(
                "means aimed",
                &[HalfMean, MeanStep, MeanStep, MeanStep, Noise, MeanStep, MeanStep],
            ),
            aimed(configured, "means kept", &[Flat, Step, Flat, MeanStep, Ramp, Same, MeanStep]),
            mixed("means of anything", &[Smooth, LightStep, Binary, MeanStep, Flicker, Noise]),
            aimed(
                ThresholdAim::HeldRegions,
                "means held",
                &[Noise, Same, Same, MeanStep, Same, MeanStep],
            ),
        ]);
        list.extend(mean_sequences_around_reset());
    }
    let leaving = aimed(ThresholdAim::Independent, "reset while pixels leave", &[Noise]);
    // The reset at the end is that of the next sequence. The last two sequences belong together.
    list.insert(list.len() - 2, cut(SequenceEnd::Leaving(0), leaving));
    list
}
