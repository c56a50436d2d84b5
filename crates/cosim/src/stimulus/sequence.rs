// SPDX-License-Identifier: MIT OR Apache-2.0
//! The list of sequences: each a reset, some frames, and a way to stream them.

use super::motif::Motif::{self, *};
use super::random::Random;

/// A sequence of frames with one thing in common.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sequence {
    /// Its name in reports.
    pub(crate) name: &'static str,
    /// What the frames show, in turn; regions of an array start at different places.
    pub(crate) motifs: &'static [Motif],
    /// How it ends.
    pub(crate) end: End,
    /// How the thresholds are chosen.
    pub(crate) thresholds: PipelinedAim,
}

/// How a sequence ends; the next begins with a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// With further frames and silence, until everything has left.
    Drained,
    /// Somewhere in a frame.
    InFrame,
    /// Soon after the last pixel of a frame.
    InFlush,
}

/// How thresholds are chosen, where they are ports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PipelinedAim {
    /// As the design is configured.
    Design,
    /// Levels on, just below or just above what a pixel of the frame has, minima likewise with the
    /// scores that are to be decided.
    Exact,
    /// Levels just below the largest value that a pixel can have, or on it; minima as with `Exact`.
    Largest,
    /// All change at every clock; minima are exact where a decision is made.
    Restless,
}

const fn drained(name: &'static str, motifs: &'static [Motif]) -> Sequence {
    Sequence { name, motifs, end: End::Drained, thresholds: PipelinedAim::Exact }
}

/// Every sequence made from motifs, the most telling first.
pub(crate) const SEQUENCES: &[Sequence] = &[
    drained("extremes", &[Max, Zero, Max, Max, Checkerboard, TwoPoint]),
    drained("noise", &[Noise, Noise, Binary, Noise]),
    Sequence {
        name: "configured",
        motifs: &[Smooth, Bump, Ramp, Bump, Flat, Same, Step, LightStep],
        end: End::Drained,
        thresholds: PipelinedAim::Design,
    },
    Sequence {
        name: "reset in a frame",
        motifs: &[Noise, Ramp, Noise],
        end: End::InFrame,
        thresholds: PipelinedAim::Exact,
    },
    drained("steps", &[Step, Ring, Step, Ramp, Step]),
    Sequence {
        name: "reset in a flush",
        motifs: &[Max, Binary],
        end: End::InFlush,
        thresholds: PipelinedAim::Exact,
    },
    drained("changes", &[Smooth, Bump, Bump, LightStep, Bump, Same]),
    Sequence {
        name: "reset after one frame",
        motifs: &[Ramp],
        end: End::InFlush,
        thresholds: PipelinedAim::Design,
    },
    drained("halves", &[HalfMean, TwoPoint, HalfMean, TwoPoint]),
    Sequence {
        name: "restless",
        motifs: &[Noise, Smooth, Binary, Ramp],
        end: End::Drained,
        thresholds: PipelinedAim::Restless,
    },
    drained("blanked", &[Noise, Same, Zero, Zero, Noise, Flat, Same, Noise]),
    drained("corners", &[HotCorner, Ring, HotCorner, Ring]),
    Sequence {
        name: "reset in a frame, full",
        motifs: &[Max, Max],
        end: End::InFrame,
        thresholds: PipelinedAim::Design,
    },
    drained("flicker", &[Smooth, Flicker, Flicker, Same]),
    drained("fade", &[Binary, Fade, Fade, Fade]),
    drained("moving pixel", &[Flat, MovingPixel, MovingPixel, MovingPixel]),
    Sequence {
        name: "largest",
        motifs: &[Quadrant, Quadrant, Quadrant, Quadrant, Quadrant],
        end: End::Drained,
        thresholds: PipelinedAim::Largest,
    },
];

/// When pixels come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gaps {
    /// One at every clock, frames back to back.
    None,
    /// At random, frames mostly back to back.
    Random,
    /// In bursts with pauses of many clocks; frames often apart far enough to flush.
    Bursts,
}

impl Gaps {
    pub(crate) const ALL: [Self; 3] = [Self::None, Self::Random, Self::Bursts];

    /// Clocks without a pixel in front of the next one.
    pub(crate) fn before_pixel(self, random: &mut Random) -> u64 {
        match self {
            Self::None => 0,
            Self::Random if random.one_in(3) => 1 + random.up_to(2),
            Self::Bursts if random.one_in(40) => 1 + random.up_to(30),
            Self::Random | Self::Bursts => 0,
        }
    }

    /// Clocks without a pixel between two frames; `drain` are enough for everything to settle.
    pub(crate) fn between_frames(self, drain: u64, random: &mut Random) -> u64 {
        match self {
            Self::None => 0,
            Self::Random => match random.up_to(3) {
                0 => 1,
                1 => random.up_to(drain),
                _ => 0,
            },
            Self::Bursts => match random.up_to(2) {
                0 => 0,
                1 => random.up_to(drain),
                _ => drain,
            },
        }
    }
}
