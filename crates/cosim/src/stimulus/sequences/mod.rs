// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sequences of a recording: each a reset, some frames, a way to stream them, and the place at which the next
//! reset finds the core.

mod pipelined;
mod raster;
mod serial;

use super::ahead::ThresholdAim;
use super::memory::Lapse;
use super::motif::Motif;
use super::random::Random;
use foveate_design::{Design, Hardware};

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
    pub(super) aim: ThresholdAim,
    /// Whether the sink, where there is one, stalls so long that regions are lost.
    pub(super) stalls: bool,
    /// What a memory outside does wrong, where there is one.
    pub(super) lapse: Lapse,
}

/// Where the reset that begins the next sequence comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// Some clocks after everything has left.
    Drained,
    /// Between the beats of a frame, up to so many clocks after one.
    Loading(u64),
    /// At one of so many clocks after the last beat of a frame.
    Flushing(u64),
    /// At the clock at which the lanes begin with a frame, or soon after it.
    Begun,
    /// At any clock of the work on a frame; every other time just before the first score is at the ports, so many clocks
    /// before the core is ready.
    Working { first_score: u64 },
    /// At one of so many clocks from the first score on.
    Rotating(u64),
    /// At one of the last so many clocks before the core is ready.
    Finishing(u64),
    /// At one of so many clocks from the first pixel on that leaves.
    Leaving(u64),
    /// At the edge at which a region would be lost in the middle, if one would.
    Losing,
}

impl Sequence {
    /// Frames whose regions show different motifs, thresholds that hit them exactly; then everything leaves.
    const fn mixed(name: &'static str, motifs: &'static [Motif]) -> Self {
        Self::aimed(ThresholdAim::Exact, name, motifs)
    }

    /// The same with thresholds that are chosen in another way.
    const fn aimed(aim: ThresholdAim, name: &'static str, motifs: &'static [Motif]) -> Self {
        Self {
            name,
            motifs,
            mixed: true,
            end: End::Drained,
            aim,
            stalls: false,
            lapse: Lapse::None,
        }
    }

    /// Frames with as many relevant regions as can be, and a reset.
    const fn cut(name: &'static str, motifs: &'static [Motif], end: End) -> Self {
        Self { end, ..Self::aimed(ThresholdAim::Least, name, motifs) }
    }
}

/// Every region shows a summary, the same again behind a reset, pixels, and that summary again.
const fn means_around_a_reset() -> [Sequence; 2] {
    use Motif::{Noise, Same, Zero};
    let aimed = Sequence::aimed;
    [
        Sequence {
            mixed: false,
            ..aimed(ThresholdAim::Unaimed, "means before a reset", &[Noise, Zero, Zero])
        },
        Sequence {
            mixed: false,
            ..aimed(
                ThresholdAim::Unaimed,
                "means behind a reset",
                &[Zero, Noise, Zero, Same, Noise],
            )
        },
    ]
}

/// Every sequence of a design, the most telling first.
pub(super) fn sequences(design: &Design) -> Vec<Sequence> {
    match design.hardware() {
        Hardware::Pipelined(own) => pipelined::sequences(design.on(own)),
        Hardware::Serial(own) => serial::sequences(design.on(own)),
        Hardware::Raster(own) => raster::sequences(design.on(own)),
    }
}

/// When pixels come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Gaps {
    /// One at every clock, frames back to back.
    None,
    /// At random, frames mostly back to back.
    Random,
    /// In bursts with pauses of many clocks; frames often apart far enough to flush.
    Bursts,
}

impl Gaps {
    pub(super) const ALL: [Self; 3] = [Self::None, Self::Random, Self::Bursts];

    /// Clocks without a pixel in front of the next one.
    pub(super) fn before_pixel(self, random: &mut Random) -> u64 {
        match self {
            Self::None => 0,
            Self::Random if random.one_in(3) => 1 + random.up_to(2),
            Self::Bursts if random.one_in(40) => 1 + random.up_to(30),
            Self::Random | Self::Bursts => 0,
        }
    }

    /// Clocks without a pixel between two frames; `settle` are enough for everything to settle.
    pub(super) fn between_frames(self, settle: u64, random: &mut Random) -> u64 {
        match self {
            Self::None => 0,
            Self::Random => match random.up_to(3) {
                0 => 1,
                1 => random.up_to(settle),
                _ => 0,
            },
            Self::Bursts => match random.up_to(2) {
                0 => 0,
                1 => random.up_to(settle),
                _ => settle,
            },
        }
    }
}
