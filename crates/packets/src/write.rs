// SPDX-License-Identifier: MIT OR Apache-2.0
//! Makes packets: each function appends one to a vector.

use crate::layout::{Layout, MAGIC, MARK, WORD};
use crate::packet::{END, FRAME, REGION, REGISTER, ROW, SCORES};
use crate::word::field;
use crate::{Decision, End, RegionFlags, Register};

/// Appends the FRAME of frame `number`.
pub fn frame(out: &mut Vec<u8>, layout: &Layout, number: u32, (time, first): (u64, bool)) {
    let info = layout.info();
    let size = u64::from(info.ticks_per_second)
        | u64::from(info.width) << 32
        | u64::from(info.height) << 48;
    let rest = u64::from(info.side)
        | u64::from(info.pixel_bits) << 8
        | u64::from(info.blocks) << 16
        | u64::from(info.irrelevant) << 24
        | u64::from(info.raw) << 28
        | u64::from(info.has_scores) << 29
        | u64::from(info.columns) << 32
        | u64::from(info.rows) << 48;
    let head = (FRAME, first.into(), info.version.into(), 0);
    packet(out, head, number, |out| {
        out.extend(MAGIC);
        out.extend([info.fingerprint, time, size, rest].into_iter().flat_map(u64::to_le_bytes));
    });
}

/// Appends the ROW of a row of regions.
pub fn row(out: &mut Vec<u8>, layout: &Layout, number: u32, row: u32, decisions: &[Decision]) {
    let bits = layout.decision_bits();
    packet(out, (ROW, 0, row, layout.columns()), number, |out| {
        for decisions in decisions.chunks(8 / bits) {
            let codes =
                decisions.iter().enumerate().map(|(at, decision)| decision.code() << (at * bits));
            out.push(codes.fold(0, |byte, code| byte | code));
        }
    });
}

/// Appends the SCORES of a row of regions; `scores` gives changed pixels and then each score of a region.
pub fn scores<S: IntoIterator<Item = u64>>(
    out: &mut Vec<u8>,
    layout: &Layout,
    number: u32,
    row: u32,
    regions: impl Iterator<Item = S>,
) {
    packet(out, (SCORES, 0, row, layout.columns()), number, |out| {
        for region in regions {
            let start = out.len();
            for ((_, bytes), value) in layout.scores().zip(region) {
                out.resize(start + (out.len() - start).next_multiple_of(bytes), 0);
                out.extend(value.to_le_bytes().iter().take(bytes));
            }
            out.resize(start + layout.record(), 0);
        }
    });
}

/// Appends a REGION; `place` is its row and column.
pub fn region(
    out: &mut Vec<u8>,
    layout: &Layout,
    number: u32,
    (row, column): (u32, u32),
    (flags, values): (RegionFlags, &[u16]),
) {
    packet(out, (REGION, flags.bits(), row, column), number, |out| match layout.lane() {
        1 => out.extend(values.iter().map(|value| value.to_le_bytes()[0])),
        _ => out.extend(values.iter().flat_map(|value| value.to_le_bytes())),
    });
}

/// Appends the END of a frame.
pub fn end(out: &mut Vec<u8>, number: u32, end: End) {
    let dropped = end.regions_dropped > 0 || end.rows_dropped > 0;
    packet(out, (END, dropped.into(), end.rows_dropped, 0), number, |out| {
        let counts = u64::from(end.regions_sent) | u64::from(end.regions_dropped) << 32;
        out.extend(counts.to_le_bytes());
    });
}

/// Appends a REGISTER, which belongs to no frame.
pub fn register(out: &mut Vec<u8>, register: Register) {
    let head = (REGISTER, register.written.into(), register.address.into(), 0);
    packet(out, head, 0, |out| out.extend(u64::from(register.value).to_le_bytes()));
}

/// Appends a packet around what `carry` writes: head before, padding to whole words and tail behind.
fn packet(
    out: &mut Vec<u8>,
    (kind, flags, row, column): (u8, u8, u32, u32),
    number: u32,
    carry: impl FnOnce(&mut Vec<u8>),
) {
    let start = out.len();
    out.extend([0; WORD]);
    carry(out);
    let carried = (out.len() - start).next_multiple_of(WORD);
    out.resize(start + carried, 0);
    let words = u64::try_from(carried / WORD + 1).unwrap_or(u64::MAX);
    let head = u64::from(MARK)
        | u64::from(kind | flags << 4) << 8
        | (words & 0xFFFF) << 16
        | field(row) << 32
        | field(column) << 48;
    if let Some(place) = out.get_mut(start..start + WORD) {
        place.copy_from_slice(&head.to_le_bytes());
    }
    out.extend(number.to_le_bytes());
    let check = crc32fast::hash(&out[start..]);
    out.extend(check.to_le_bytes());
}

impl Decision {
    /// Its bits in a ROW.
    fn code(self) -> u8 {
        u8::from(self.srs) | u8::from(self.trs) << 1 | u8::from(self.summary) << 2
    }
}
