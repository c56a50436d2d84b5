// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a serial array.

use super::super::ahead::ThresholdAim;
use super::super::motif::Motif::*;
use super::{End, Sequence, means_around_a_reset};
use foveate_design::{Phase, SerialDesign, SerialTiming};

/// Returns all sequences, the most telling first. Sequences that end with a reset within a frame
/// alternate with the others, so that the remaining state meets another kind of frame each time.
pub(super) fn sequences(design: SerialDesign<'_>) -> Vec<Sequence> {
    let (mixed, aimed, cut) = (Sequence::mixed, Sequence::aimed, Sequence::cut);
    let loading = End::Loading(2);
    let timing = SerialTiming::of(design);
    let before = |&&(phase, _): &&(Phase, u64)| phase != Phase::RotateCount;
    let steps: u64 = timing.phases().iter().take_while(before).map(|&(_, steps)| steps).sum();
    let first_score = timing.edges_to_ready() - timing.edges_to_step(steps);
    let working = End::Working { first_score };
    let rotating = End::Rotating(design.lanes().into());
    // The pixels of the last slot leave last.
    let unloading = End::Finishing(timing.phases().last().expect("a frame has phases").1);
    let ready = End::Finishing(2);
    let passes = |&&(phase, _): &&(Phase, u64)| matches!(phase, Phase::RotateCount | Phase::Means);
    let passing =
        End::Rotating(timing.phases().iter().filter(passes).map(|&(_, steps)| steps).sum());
    let mut list = vec![
        Sequence { mixed: false, ..mixed("extremes", &[Max, Zero, Checkerboard, TwoPoint]) },
        cut("reset while loading", &[Noise, Ramp], loading),
        mixed("steps", &[Step, Ring, HotCorner, Ramp]),
        cut("reset at the start", &[Binary], End::Begun),
        mixed("changes", &[Smooth, Bump, LightStep, Same, Bump]),
        cut("reset in a rotation", &[Noise, Binary], rotating),
        aimed(ThresholdAim::Design, "configured", &[Smooth, Bump, Ramp, Flat, Same]),
        cut("reset while unloading", &[Noise], unloading),
        cut("blanked", &[Noise, Same, Zero, Zero, Noise, Same, MovingPixel], End::Drained),
        cut("reset at work", &[TwoPoint, Max], working),
        mixed("halves", &[HalfMean, TwoPoint, HalfMean]),
        cut("reset when ready", &[Max], ready),
        mixed("fades", &[Smooth, Flicker, Fade, Fade, MovingPixel]),
        Sequence {
            mixed: false,
            ..aimed(
                ThresholdAim::Largest,
                "largest",
                &[Quadrant, Quadrant, Quadrant, Quadrant, Quadrant],
            )
        },
    ];
    if design.periphery().is_some() {
        // The changes of means meet the level or miss it by one; in arrays of a few regions in
        // turn.
        list.splice(
            3..3,
            [
                mixed(
                    "means",
                    &[HalfMean, MeanStep, MeanStep, MeanStep, Noise, MeanStep, MeanStep],
                ),
                cut("reset while means leave", &[Flat, MeanStep], unloading),
                cut("reset while means pass", &[MeanStep, Flat], passing),
                aimed(
                    ThresholdAim::Design,
                    "means kept",
                    &[Flat, MeanStep, MeanStep, Step, MeanStep, MeanStep],
                ),
            ],
        );
        list.push(aimed(
            ThresholdAim::Held,
            "means held",
            &[Noise, Same, Same, MeanStep, Same, MeanStep],
        ));
        list.extend(means_around_a_reset());
    }
    let leaving = Sequence {
        end: End::Leaving(0),
        ..aimed(ThresholdAim::Unaimed, "reset while pixels leave", &[Noise])
    };
    // The reset at the end is that of the next sequence. The last two sequences belong together.
    list.insert(list.len() - 2, leaving);
    list
}
