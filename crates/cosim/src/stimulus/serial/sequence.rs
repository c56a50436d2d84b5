// SPDX-License-Identifier: MIT OR Apache-2.0
//! The list of sequences of a serial array: each a reset, a few frames, and the place at which the next
//! reset finds the array.

use super::super::ahead::FrameAim;
use super::super::motif::Motif::{self, *};

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
}

/// Where the reset that begins the next sequence comes; after everything has left, but for these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// Some clocks after `ready_o` has come.
    Drained,
    /// Between the pixels of a frame.
    Loading,
    /// At T0, or soon after it.
    Start,
    /// At any clock of the work.
    Working,
    /// While scores are at the ports.
    Rotating,
    /// While pixels leave.
    Unloading,
    /// When `ready_o` comes, or the clock before.
    Ready,
}

const fn mixed(name: &'static str, motifs: &'static [Motif]) -> Sequence {
    Sequence { name, motifs, mixed: true, end: End::Drained, aim: FrameAim::Exact }
}

const fn cut(name: &'static str, motifs: &'static [Motif], end: End) -> Sequence {
    Sequence { name, motifs, mixed: true, end, aim: FrameAim::Least }
}

/// Every sequence, the most telling first. Resets that cut a frame short alternate with the others, so
/// that what they leave behind meets another kind of frame each time.
pub(super) const SEQUENCES: &[Sequence] = &[
    Sequence {
        name: "extremes",
        motifs: &[Max, Zero, Checkerboard, TwoPoint],
        mixed: false,
        end: End::Drained,
        aim: FrameAim::Exact,
    },
    cut("reset while loading", &[Noise, Ramp], End::Loading),
    mixed("steps", &[Step, Ring, HotCorner, Ramp]),
    cut("reset at the start", &[Binary], End::Start),
    mixed("changes", &[Smooth, Bump, LightStep, Same, Bump]),
    cut("reset in a rotation", &[Noise, Binary], End::Rotating),
    Sequence {
        name: "configured",
        motifs: &[Smooth, Bump, Ramp, Flat, Same],
        mixed: true,
        end: End::Drained,
        aim: FrameAim::Design,
    },
    cut("reset while unloading", &[Noise], End::Unloading),
    Sequence {
        name: "blanked",
        motifs: &[Noise, Same, Zero, Zero, Noise, Same, MovingPixel],
        mixed: true,
        end: End::Drained,
        aim: FrameAim::Least,
    },
    cut("reset at work", &[TwoPoint, Max], End::Working),
    mixed("halves", &[HalfMean, TwoPoint, HalfMean]),
    cut("reset when ready", &[Max], End::Ready),
    mixed("fades", &[Smooth, Flicker, Fade, Fade, MovingPixel]),
    Sequence {
        name: "largest",
        motifs: &[Quadrant, Quadrant, Quadrant, Quadrant, Quadrant],
        mixed: false,
        end: End::Drained,
        aim: FrameAim::Largest,
    },
];
