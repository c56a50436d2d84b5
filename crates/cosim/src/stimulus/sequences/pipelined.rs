// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a pipelined RPU, and of an array of them.

use super::super::ahead::ThresholdAim;
use super::super::motif::Motif::*;
use super::super::pace::settling_clocks;
use super::{End, Sequence, means_around_a_reset};
use foveate_design::PipelinedDesign;

/// Returns all sequences, the most telling first.
pub(super) fn sequences(design: PipelinedDesign<'_>) -> Vec<Sequence> {
    let (mixed, aimed) = (Sequence::mixed, Sequence::aimed);
    let flushing = End::Flushing(settling_clocks(design));
    // The reset comes at once, while most is under way.
    let loading = End::Loading(0);
    let cut = |end, sequence| Sequence { end, ..sequence };
    let configured = ThresholdAim::Design;
    let mut list = vec![
        mixed("extremes", &[Max, Zero, Max, Max, Checkerboard, TwoPoint]),
        mixed("noise", &[Noise, Noise, Binary, Noise]),
        aimed(configured, "configured", &[Smooth, Bump, Ramp, Bump, Flat, Same, Step, LightStep]),
        cut(loading, mixed("reset in a frame", &[Noise, Ramp, Noise])),
        mixed("steps", &[Step, Ring, Step, Ramp, Step]),
        cut(flushing, mixed("reset in a flush", &[Max, Binary])),
        mixed("changes", &[Smooth, Bump, Bump, LightStep, Bump, Same]),
        cut(flushing, aimed(configured, "reset after one frame", &[Ramp])),
        mixed("halves", &[HalfMean, TwoPoint, HalfMean, TwoPoint]),
        aimed(ThresholdAim::Restless, "restless", &[Noise, Smooth, Binary, Ramp]),
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
            aimed(ThresholdAim::Held, "means held", &[Noise, Same, Same, MeanStep, Same, MeanStep]),
        ]);
        list.extend(means_around_a_reset());
    }
    let leaving = aimed(ThresholdAim::Unaimed, "reset while pixels leave", &[Noise]);
    // The reset at the end is that of the next sequence. The last two sequences belong together.
    list.insert(list.len() - 2, cut(End::Leaving(0), leaving));
    list
}
