// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a serial array.

use super::super::sequence_end::SequenceEnd;
use super::super::stimulus_pattern::StimulusPattern::{self, *};
use super::super::stimulus_pattern::Texture as TextureKind;
use super::{CHECKERBOARD, FrameSequence, mean_sequences_around_reset};
use crate::stimulus::threshold_ranges::ThresholdAim;
use foveate_design::{SerialDesign, SerialPhase, SerialTiming};

const ROWS: StimulusPattern = Texture(TextureKind::Rows(2));
const COLUMNS: StimulusPattern = Texture(TextureKind::Columns(2));
const STRIPES: StimulusPattern = Texture(TextureKind::Columns(1));
const DOTS: StimulusPattern = Texture(TextureKind::Dots(1, 3));

/// Returns all sequences, the most telling first. Sequences that end with a reset within a frame
/// alternate with the others, so that the remaining state meets another kind of frame each time.
pub(super) fn sequences(design: SerialDesign<'_>) -> Vec<FrameSequence> {
    let (mixed, aimed, cut) =
        (FrameSequence::with_exact_thresholds, FrameSequence::with_aim, FrameSequence::ending_at);
    let loading = SequenceEnd::Loading(2);
    let timing = SerialTiming::from_design(design);
    let before = |&&(phase, _): &&(SerialPhase, u64)| phase != SerialPhase::RotateCount;
    let steps: u64 = timing.phases().iter().take_while(before).map(|&(_, steps)| steps).sum();
    let first_score = timing.edges_to_ready() - timing.edges_to_step(steps);
    let working = SequenceEnd::Working { first_score };
    let rotating = SequenceEnd::Rotating(design.lanes().into());
    // The pixels of the last slot leave last.
    let unloading = SequenceEnd::Finishing(timing.phases().last().expect("a frame has phases").1);
    let ready = SequenceEnd::Finishing(2);
    let passes = |&&(phase, _): &&(SerialPhase, u64)| {
        matches!(phase, SerialPhase::RotateCount | SerialPhase::ComputeMeans)
    };
    let passing =
        SequenceEnd::Rotating(timing.phases().iter().filter(passes).map(|&(_, steps)| steps).sum());
    let mut list = vec![
        FrameSequence {
            is_mixed: false,
            ..mixed("extremes", &[Max, Zero, CHECKERBOARD, TwoPoint])
        },
        cut("reset while loading", &[Noise, Ramp], loading),
        mixed("steps", &[Step, Ring, HotCorner, Ramp]),
        cut("reset at the start", &[Binary], SequenceEnd::LanesStarted),
        mixed("changes", &[Smooth, Bump, LightStep, Same, Bump]),
        cut("reset in a rotation", &[Noise, Binary], rotating),
        aimed(ThresholdAim::Configured, "configured", &[Smooth, Bump, Ramp, Flat, Same]),
        cut("reset while unloading", &[Noise], unloading),
        cut("blanked", &[Noise, Same, Zero, Zero, Noise, Same, MovingPixel], SequenceEnd::Drained),
        cut("reset at work", &[TwoPoint, Max], working),
        mixed("halves", &[HalfMean, TwoPoint, HalfMean]),
        cut("reset when ready", &[Max], ready),
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
    if design.flow_search().is_some() {
        // Content that moves, stands still, and is the same along rows, along columns or
        // everywhere, so that several displacements are equally good. Stripes that move by an odd
        // number of columns have the largest score.
        list.splice(
            1..1,
            [
                mixed(
                    "movements",
                    &[Noise, Moved, Moved, Same, Moved, Blocks, Moved, Smooth, Moved, Flicker],
                ),
                mixed(
                    "equal movements",
                    &[ROWS, Moved, Moved, COLUMNS, Moved, Flat, Moved, DOTS, Moved, Moved],
                ),
                FrameSequence {
                    is_mixed: false,
                    ..mixed("largest movements", &[STRIPES, Moved, Moved, Moved])
                },
                aimed(
                    ThresholdAim::Smallest,
                    "movements of sent regions",
                    &[Noise, Moved, Same, Moved, Zero, Noise, Moved, Moved],
                ),
            ],
        );
    }
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
                    ThresholdAim::Configured,
                    "means kept",
                    &[Flat, MeanStep, MeanStep, Step, MeanStep, MeanStep],
                ),
            ],
        );
        list.push(aimed(
            ThresholdAim::HeldRegions,
            "means held",
            &[Noise, Same, Same, MeanStep, Same, MeanStep],
        ));
        list.extend(mean_sequences_around_reset());
    }
    let leaving = FrameSequence {
        end: SequenceEnd::Leaving(0),
        ..aimed(
            ThresholdAim::Independent,
            "reset while pixels leave",
            // With `flow` alone no region is relevant in the first frame.
            if design.flow_search().is_some() { &[Noise, Moved] } else { &[Noise] },
        )
    };
    // The reset at the end is that of the next sequence. The last two sequences belong together.
    list.insert(list.len() - 2, leaving);
    list
}
