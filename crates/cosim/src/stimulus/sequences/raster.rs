// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a raster core.

use super::super::ahead::ThresholdAim;
use super::super::memory::Lapse;
use super::super::motif::Motif::*;
use super::{End, Sequence, means_around_a_reset};
use foveate_design::{RasterDesign, RasterTiming};

/// Returns all sequences, the most telling first. Sequences that end with a reset within a frame
/// alternate with the others, so that the remaining state meets another kind of frame each time.
pub(super) fn sequences(design: RasterDesign<'_>) -> Vec<Sequence> {
    let (mixed, aimed, cut) = (Sequence::mixed, Sequence::aimed, Sequence::cut);
    let loading = End::Loading(2);
    let timing = RasterTiming::of(design);
    let flushing = End::Flushing(timing.edges_to_ready());
    let leaving = End::Leaving(2 * u64::from(timing.region_words));
    let mut sequences = vec![
        Sequence { mixed: false, ..mixed("extremes", &[Max, Zero, Checkerboard, TwoPoint]) },
        cut("reset while loading", &[Noise, Ramp], loading),
        Sequence {
            stalls: true,
            ..cut("losses", &[Noise, Same, Binary, Same, Same, Noise], End::Drained)
        },
        cut("reset in the flush", &[Noise, Binary], flushing),
        mixed("steps", &[Step, Ring, HotCorner, Ramp]),
        Sequence { stalls: true, ..cut("reset after losses", &[Noise, Max, Binary], leaving) },
        Sequence { stalls: true, ..cut("reset at a loss", &[Noise, Binary, Max], End::Losing) },
        mixed("changes", &[Smooth, Bump, LightStep, Same, Bump]),
        cut("reset while pixels leave", &[Noise], leaving),
        aimed(ThresholdAim::Design, "configured", &[Smooth, Bump, Ramp, Flat, Same]),
        cut("reset after one frame", &[TwoPoint], flushing),
        aimed(ThresholdAim::Least, "blanked", &[Noise, Same, Zero, Zero, Noise, Same, MovingPixel]),
        Sequence {
            stalls: true,
            ..aimed(
                ThresholdAim::Least,
                "blanked and lost",
                &[Noise, Zero, Noise, Same, Zero, Noise, Same],
            )
        },
        mixed("halves", &[HalfMean, TwoPoint, HalfMean]),
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
        sequences.extend(means());
        // All regions send means, and one mean is on the ports; a reset must follow.
        sequences.push(Sequence {
            mixed: false,
            end: End::Leaving(0),
            ..aimed(ThresholdAim::Unaimed, "reset while means leave", &[Zero])
        });
        sequences.extend(means_around_a_reset());
    }
    if design.frames_are_kept_outside() {
        sequences.extend(failing(flushing));
    }
    sequences
}

/// Returns sequences with means that meet the level or miss it by one, means that are lost, means
/// that stay on the screen while their region is held, and means that leave beside relevant regions
/// which drift away from what was last sent.
fn means() -> [Sequence; 6] {
    let (mixed, aimed) = (Sequence::mixed, Sequence::aimed);
    let configured = ThresholdAim::Design;
    [
        aimed(configured, "means", &[Flat, MeanStep, MeanStep, MeanStep, MeanStep, MeanStep]),
        Sequence {
            stalls: true,
            ..aimed(configured, "means lost", &[Flat, MeanStep, Same, Step, Same, MeanStep, Flat])
        },
        aimed(configured, "means kept", &[Flat, Step, Flat, MeanStep, Ramp, Same, MeanStep]),
        mixed("means of anything", &[Smooth, LightStep, Binary, MeanStep, Flicker, Noise]),
        aimed(ThresholdAim::Held, "means held", &[Noise, Same, Same, MeanStep, Same, MeanStep]),
        Sequence {
            mixed: false,
            ..aimed(
                ThresholdAim::Drifting,
                "means beside pixels",
                &[Step, Fade, Fade, Step, Fade, Fade, HotCorner, Fade, Fade],
            )
        },
    ]
}

/// Returns the sequences with a faulty external frame store.
fn failing(flushing: End) -> [Sequence; 7] {
    let (mixed, aimed, cut) = (Sequence::mixed, Sequence::aimed, Sequence::cut);
    let loading = End::Loading(2);
    [
        Sequence {
            lapse: Lapse::Late,
            ..mixed("late references", &[Smooth, Bump, Same, Noise, Same])
        },
        Sequence {
            lapse: Lapse::Late,
            ..cut("reset after an underrun", &[Noise, Binary, Ramp, Noise], loading)
        },
        Sequence {
            lapse: Lapse::Gone,
            ..aimed(ThresholdAim::Least, "lost references", &[Noise, Same, Same, Noise])
        },
        cut("reset while references come", &[Noise, Same, Same], loading),
        Sequence {
            lapse: Lapse::Wrong,
            ..mixed("wrong references", &[Ramp, Same, Same, Noise, Same])
        },
        Sequence {
            lapse: Lapse::Wrong,
            mixed: false,
            ..aimed(ThresholdAim::Design, "wrong references of extremes", &[Max, Max, Zero, Zero])
        },
        cut("reset after wrong references", &[Smooth, Same], flushing),
    ]
}
