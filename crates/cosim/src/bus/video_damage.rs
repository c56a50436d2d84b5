// SPDX-License-Identifier: MIT OR Apache-2.0
//! Damaged frames, and the frames that the core must make of them, from the table of `docs/axi.md`.

use super::traffic::{Traffic, rows};
use crate::stimulus::Random;
use foveate_pixels::Frame;

/// The number of random draws of lines to damage in a frame.
const DAMAGED_LINES: usize = 3;
/// The largest number of transfers by which a line is too long.
const MAX_EXTRA_TRANSFERS: u64 = 8;

/// A kind of damage to a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum VideoDamage {
    /// Some lines end early.
    ShortLines,
    /// The first and the last line end after one transfer.
    ShortEnds,
    /// Some lines do not end in time.
    LongLines,
    /// The last line does not end in time.
    LongEnd,
    /// The next frame begins between two lines, or within the line of a frame that has no others.
    EarlyBetween,
    /// The next frame begins within a line.
    EarlyWithin,
    /// Transfers follow a whole frame.
    Late,
    /// The frame has no start.
    NoStart,
}

impl VideoDamage {
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
        let chosen: Vec<u32> = (0..DAMAGED_LINES).map(|_| random.up_to_u32(height - 1)).collect();
        let stop = if height > 1 { 1 + random.up_to_u32(height - 2) } else { 0 };
        for (y, row) in (0..).zip(rows(frame)) {
            let is_last = y == height - 1;
            let some = self.damages_line(chosen.contains(&y), y == 0 || is_last, is_last);
            match self {
                Self::EarlyBetween if y == stop && y > 0 => {
                    return Some(repeat_last_row(repaired, stop));
                }
                Self::EarlyBetween | Self::EarlyWithin if y == stop => {
                    let line = send_line_start(traffic, random, row, (y == 0, false));
                    repaired.write_row(0, y, &line);
                    return Some(repeat_last_row(repaired, stop + 1));
                }
                Self::ShortLines | Self::ShortEnds if some => {
                    let line = match self {
                        Self::ShortLines => send_line_start(traffic, random, row, (y == 0, true)),
                        _ => send_first_words(traffic, 1, row, (y == 0, true)),
                    };
                    repaired.write_row(0, y, &line);
                }
                Self::LongLines | Self::LongEnd if some => {
                    send_long_line(traffic, random, row, y == 0);
                }
                _ => send_line(traffic, row, (y == 0 && self != Self::NoStart, true)),
            }
        }
        if self == Self::Late {
            let count = 1 + random.index(2 * traffic.words_per_line());
            for _ in 0..count {
                let eol = random.one_in(3);
                send_noise(traffic, random, eol);
            }
        }
        (self != Self::NoStart).then_some(repaired)
    }

    /// Returns true if a line has this damage. `is_chosen` marks a randomly chosen line, `is_end`
    /// the first or last line, `is_last` the last line.
    fn damages_line(self, is_chosen: bool, is_end: bool, is_last: bool) -> bool {
        match self {
            Self::ShortLines | Self::LongLines => is_chosen,
            Self::ShortEnds => is_end,
            Self::LongEnd => is_last,
            _ => false,
        }
    }
}

/// Returns the frame with every row from `from` on replaced by the row before `from`.
fn repeat_last_row(mut frame: Frame, from: u32) -> Frame {
    let last = frame.row(from - 1).to_vec();
    (from..frame.height()).for_each(|y| frame.write_row(0, y, &last));
    frame
}

/// Sends a line. `sof` says that it begins a frame, `eol` that its last transfer is marked.
fn send_line(traffic: &mut Traffic<'_>, row: &[u16], (sof, eol): (bool, bool)) {
    send_first_words(traffic, traffic.words_per_line(), row, (sof, eol));
}

/// Sends a random part of the beginning of a line. Returns the line that the core makes of it.
fn send_line_start(
    traffic: &mut Traffic<'_>,
    random: &mut Random,
    row: &[u16],
    ends: (bool, bool),
) -> Vec<u16> {
    let words = 1 + random.index(traffic.words_per_line() - 2);
    send_first_words(traffic, words, row, ends)
}

/// Sends the first `words` transfers of a line. `sof` says that the first of them begins a frame,
/// `eol` that the last of them is marked as the end of the line. Returns the line that the core
/// makes of it.
pub(super) fn send_first_words(
    traffic: &mut Traffic<'_>,
    words: usize,
    row: &[u16],
    (sof, eol): (bool, bool),
) -> Vec<u16> {
    let mut kept = Vec::with_capacity(row.len());
    for (at, pixels) in traffic.split_line(row).take(words).enumerate() {
        traffic.send_beat(sof && at == 0, eol && at == words - 1, pixels);
        kept.extend(pixels);
    }
    let last = kept.last().copied().unwrap_or_default();
    kept.resize(row.len(), last);
    kept
}

/// Sends a line that does not end in time, with up to `MAX_EXTRA_TRANSFERS` transfers too many.
fn send_long_line(traffic: &mut Traffic<'_>, random: &mut Random, row: &[u16], sof: bool) {
    send_line(traffic, row, (sof, false));
    let more = random.up_to(MAX_EXTRA_TRANSFERS - 1);
    for _ in 0..more {
        send_noise(traffic, random, false);
    }
    send_noise(traffic, random, true);
}

/// Sends a transfer that the core must ignore.
fn send_noise(traffic: &mut Traffic<'_>, random: &mut Random, eol: bool) {
    let max = traffic.max_pixel();
    let pixels: Vec<u16> =
        (0..traffic.design().pixels_per_clock()).map(|_| random.pixel(max)).collect();
    traffic.send_beat(false, eol, &pixels);
}
