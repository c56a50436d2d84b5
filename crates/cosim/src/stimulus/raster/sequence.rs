// SPDX-License-Identifier: MIT OR Apache-2.0
//! The list of sequences of a raster core: each a reset, a few frames in front of a sink, and the place at
//! which the next reset finds the core.

use super::super::ahead::FrameAim;
use super::super::motif::Motif::{self, *};
use super::memory::Lapse;
use foveate_design::{RasterDesign, Store};

/// A sequence of frames with one thing in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sequence {
    /// Its name in reports.
    pub(super) name: &'static str,
    /// What the regions show, frame by frame.
    pub(super) motifs: &'static [Motif],
    /// Whether every region starts at another motif.
    pub(super) mixed: bool,
    /// How it ends.
    pub(super) end: End,
    /// How thresholds are chosen.
    pub(super) aim: FrameAim,
    /// Whether its sink stalls so long that regions are lost.
    pub(super) stalls: bool,
    /// What a memory outside does wrong.
    pub(super) lapse: Lapse,
}

/// Where the reset that begins the next sequence comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// Some clocks after everything has left.
    Drained,
    /// Between the words of a frame.
    Loading,
    /// While `ready_o` is 0 after the last word of a frame.
    Flushing,
    /// While pixels leave.
    Leaving,
    /// At the edge at which a region would be lost in the middle, if one would.
    Losing,
}

const fn mixed(name: &'static str, motifs: &'static [Motif]) -> Sequence {
    Sequence {
        name,
        motifs,
        mixed: true,
        end: End::Drained,
        aim: FrameAim::Exact,
        stalls: false,
        lapse: Lapse::None,
    }
}

const fn cut(name: &'static str, motifs: &'static [Motif], end: End) -> Sequence {
    Sequence { end, aim: FrameAim::Least, ..mixed(name, motifs) }
}

/// The sequences of a design.
pub(super) fn sequences(design: RasterDesign<'_>) -> Vec<Sequence> {
    let failing = if design.store() == Store::External { FAILING } else { &[] };
    SEQUENCES.iter().chain(failing).copied().collect()
}

/// Every sequence that any core has, the most telling first. Resets that cut a frame short alternate with the others, so
/// that what they leave behind meets another kind of frame each time.
const SEQUENCES: &[Sequence] = &[
    Sequence { mixed: false, ..mixed("extremes", &[Max, Zero, Checkerboard, TwoPoint]) },
    cut("reset while loading", &[Noise, Ramp], End::Loading),
    Sequence {
        aim: FrameAim::Least,
        stalls: true,
        ..mixed("losses", &[Noise, Same, Binary, Same, Same, Noise])
    },
    cut("reset in the flush", &[Noise, Binary], End::Flushing),
    mixed("steps", &[Step, Ring, HotCorner, Ramp]),
    Sequence { stalls: true, ..cut("reset after losses", &[Noise, Max, Binary], End::Leaving) },
    Sequence { stalls: true, ..cut("reset at a loss", &[Noise, Binary, Max], End::Losing) },
    mixed("changes", &[Smooth, Bump, LightStep, Same, Bump]),
    cut("reset while pixels leave", &[Noise], End::Leaving),
    Sequence { aim: FrameAim::Design, ..mixed("configured", &[Smooth, Bump, Ramp, Flat, Same]) },
    cut("reset after one frame", &[TwoPoint], End::Flushing),
    Sequence {
        aim: FrameAim::Least,
        ..mixed("blanked", &[Noise, Same, Zero, Zero, Noise, Same, MovingPixel])
    },
    Sequence {
        aim: FrameAim::Least,
        stalls: true,
        ..mixed("blanked and lost", &[Noise, Zero, Noise, Same, Zero, Noise, Same])
    },
    mixed("halves", &[HalfMean, TwoPoint, HalfMean]),
    mixed("fades", &[Smooth, Flicker, Fade, Fade, MovingPixel]),
    Sequence {
        mixed: false,
        aim: FrameAim::Largest,
        ..mixed("largest", &[Quadrant, Quadrant, Quadrant, Quadrant, Quadrant])
    },
];

/// What a core must survive whose frame store is outside.
const FAILING: &[Sequence] = &[
    Sequence { lapse: Lapse::Late, ..mixed("late references", &[Smooth, Bump, Same, Noise, Same]) },
    Sequence {
        lapse: Lapse::Late,
        ..cut("reset after an underrun", &[Noise, Binary, Ramp, Noise], End::Loading)
    },
    Sequence {
        lapse: Lapse::Gone,
        aim: FrameAim::Least,
        ..mixed("lost references", &[Noise, Same, Same, Noise])
    },
    cut("reset while references come", &[Noise, Same, Same], End::Loading),
    Sequence { lapse: Lapse::Wrong, ..mixed("wrong references", &[Ramp, Same, Same, Noise, Same]) },
    Sequence {
        lapse: Lapse::Wrong,
        mixed: false,
        aim: FrameAim::Design,
        ..mixed("wrong references of extremes", &[Max, Max, Zero, Zero])
    },
    cut("reset after wrong references", &[Smooth, Same], End::Flushing),
];
