// SPDX-License-Identifier: MIT OR Apache-2.0
//! Damaged frames, and the frames that the core must make of them, from the table of `docs/axi.md`.

use super::film::largest;
use super::traffic::{Traffic, rows};
use crate::stimulus::Random;
use foveate_frame::Frame;

/// The number of random draws of lines to damage in a frame.
const ROWS: usize = 3;
/// The largest number of transfers by which a line is too long.
const MORE: u64 = 8;

/// A kind of damage to a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Damage {
    /// Some lines end early.
    ShortLines,
    /// The first and the last line end after one transfer.
    ShortEnds,
    /// Some lines do not end in time.
    LongLines,
    /// The last line does not end in time.
    LongEnd,
    /// The next frame begins between two lines.
    EarlyBetween,
    /// The next frame begins within a line.
    EarlyWithin,
    /// Transfers follow a whole frame.
    Late,
    /// The frame has no start.
    NoStart,
}

impl Damage {
    pub(super) const ALL: [Self; 8] = [
        Self::ShortLines,
        Self::ShortEnds,
        Self::LongLines,
        Self::LongEnd,
        Self::EarlyBetween,
        Self::EarlyWithin,
        Self::Late,
        Self::NoStart,
    ];

    /// Returns the event that reports the damage.
    pub(super) fn event(self) -> &'static str {
        match self {
            Self::ShortLines | Self::ShortEnds => "eol_early",
            Self::LongLines | Self::LongEnd => "eol_late",
            Self::EarlyBetween | Self::EarlyWithin => "sof_early",
            Self::Late | Self::NoStart => "sof_late",
        }
    }

    /// Returns true if the core counts the frame as repaired.
    pub(super) fn is_repaired(self) -> bool {
        !matches!(self, Self::Late | Self::NoStart)
    }

    /// Sends a frame with this damage; a whole frame must follow. Returns the frame that the array
    /// must see, or `None` if it sees none.
    pub(super) fn send(
        self,
        traffic: &mut Traffic<'_>,
        random: &mut Random,
        frame: &Frame,
    ) -> Option<Frame> {
        let mut repaired = frame.clone();
        let height = frame.height();
        let chosen: Vec<u32> = (0..ROWS).map(|_| random.up_to_u32(height - 1)).collect();
        let stop = 1 + random.up_to_u32(height - 2);
        for (y, row) in (0..).zip(rows(frame)) {
            let is_last = y == height - 1;
            let some = self.in_line(chosen.contains(&y), y == 0 || is_last, is_last);
            match self {
                Self::EarlyBetween if y == stop => return Some(copied(repaired, stop)),
                Self::EarlyWithin if y == stop => {
                    let line = cut(traffic, random, row, (false, false));
                    repaired.write(0, y, &line);
                    return Some(copied(repaired, stop + 1));
                }
                Self::ShortLines | Self::ShortEnds if some => {
                    let line = match self {
                        Self::ShortLines => cut(traffic, random, row, (y == 0, true)),
                        _ => cut_at(traffic, 1, row, (y == 0, true)),
                    };
                    repaired.write(0, y, &line);
                }
                Self::LongLines | Self::LongEnd if some => {
                    long(traffic, random, row, y == 0);
                }
                _ => line(traffic, row, (y == 0 && self != Self::NoStart, true)),
            }
        }
        if self == Self::Late {
            let count = 1 + random.index(2 * traffic.words());
            for _ in 0..count {
                let eol = random.one_in(3);
                noise(traffic, random, eol);
            }
        }
        (self != Self::NoStart).then_some(repaired)
    }

    /// Returns true if a line has this damage. `is_chosen` marks a randomly chosen line, `is_end`
    /// the first or last line, `is_last` the last line.
    fn in_line(self, is_chosen: bool, is_end: bool, is_last: bool) -> bool {
        match self {
            Self::ShortLines | Self::LongLines => is_chosen,
            Self::ShortEnds => is_end,
            Self::LongEnd => is_last,
            _ => false,
        }
    }
}

/// Returns the frame with every row from `from` on replaced by the row before `from`.
fn copied(mut frame: Frame, from: u32) -> Frame {
    let last = frame.row(from - 1).to_vec();
    (from..frame.height()).for_each(|y| frame.write(0, y, &last));
    frame
}

/// Sends a line. `sof` says that it begins a frame, `eol` that its last transfer is marked.
fn line(traffic: &mut Traffic<'_>, row: &[u16], (sof, eol): (bool, bool)) {
    cut_at(traffic, traffic.words(), row, (sof, eol));
}

/// Sends a random part of the beginning of a line. Returns the line that the core makes of it.
fn cut(
    traffic: &mut Traffic<'_>,
    random: &mut Random,
    row: &[u16],
    ends: (bool, bool),
) -> Vec<u16> {
    let words = 1 + random.index(traffic.words() - 2);
    cut_at(traffic, words, row, ends)
}

fn cut_at(
    traffic: &mut Traffic<'_>,
    words: usize,
    row: &[u16],
    (sof, eol): (bool, bool),
) -> Vec<u16> {
    let mut kept = Vec::with_capacity(row.len());
    for (at, pixels) in traffic.split(row).take(words).enumerate() {
        traffic.beat(sof && at == 0, eol && at == words - 1, pixels);
        kept.extend(pixels);
    }
    let last = kept.last().copied().unwrap_or_default();
    kept.resize(row.len(), last);
    kept
}

/// Sends a line that does not end in time, with up to `MORE` transfers too many.
fn long(traffic: &mut Traffic<'_>, random: &mut Random, row: &[u16], sof: bool) {
    line(traffic, row, (sof, false));
    let more = random.up_to(MORE - 1);
    for _ in 0..more {
        noise(traffic, random, false);
    }
    noise(traffic, random, true);
}

/// Sends a transfer that the core must ignore.
fn noise(traffic: &mut Traffic<'_>, random: &mut Random, eol: bool) {
    let design = traffic.design();
    let pixels: Vec<u16> = (0..design.pixels_per_clock())
        .map(|_| random.pixel(largest(design.pixel_bits())))
        .collect();
    traffic.beat(false, eol, &pixels);
}
