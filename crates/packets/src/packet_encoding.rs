// SPDX-License-Identifier: MIT OR Apache-2.0
//! Makes packets. Each function appends one packet to a vector, or appends nothing and fails if the
//! packet does not fit the format.

use foveate_camera::Displacement;

use super::packet_layout::{checked_field, checked_u16};
use crate::packet::{
    END_TYPE, FLOW_TYPE, FRAME_TYPE, REGION_TYPE, REGISTER_TYPE, ROW_TYPE, SCORES_TYPE,
};
use crate::packet_layout::{
    END_WORDS, FRAME_WORDS, HEAD_AND_TAIL_WORDS, MAGIC, MARK, PacketLayout, REGISTER_WORDS,
    WORD_BYTES,
};
use crate::{EndPacket, PacketError, RegionDecision, RegionFlags, RegisterPacket};

/// Appends the FRAME of frame `number`. The time is in ticks. In a design with zones, the frame
/// uses the map of classes of the configuration, which has version 0.
pub fn append_frame(out: &mut Vec<u8>, layout: &PacketLayout, number: u32, start: (u64, bool)) {
    append_checked_frame(out, layout, number, start, 0);
}

/// Appends the FRAME of frame `number`, which uses the map of classes with this version. The time
/// is in ticks.
///
/// # Errors
/// Fails if the version is not 0 in a design without zones.
pub fn append_frame_of_map(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    number: u32,
    start: (u64, bool),
    map_version: u16,
) -> Result<(), PacketError> {
    let most = layout.map_version_max().into();
    checked_field("version of the map", map_version.into(), 0..=most)?;
    append_checked_frame(out, layout, number, start, map_version);
    Ok(())
}

/// Appends a FRAME with a version of the map that the design can have.
fn append_checked_frame(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    number: u32,
    (time, first): (u64, bool),
    map_version: u16,
) {
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
    let (flags, row) = (first.into(), info.version);
    let head = PacketFields { kind: FRAME_TYPE, flags, row, column: map_version };
    append_packet(out, head, FRAME_WORDS, number, |out| {
        out.extend(MAGIC);
        out.extend([info.fingerprint, time, size, rest].into_iter().flat_map(u64::to_le_bytes));
    });
}

/// Appends the ROW of a row of regions.
///
/// # Errors
/// Fails if there is no such row, or if the number of decisions is not that of its regions.
pub fn append_row(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    number: u32,
    row: u32,
    decisions: &[RegionDecision],
) -> Result<(), PacketError> {
    let head = PacketFields::of_row(ROW_TYPE, layout, row)?;
    check_count("ROW", "decisions", decisions.len(), layout.info().columns.into())?;
    let bits = layout.decision_bits();
    append_packet(out, head, layout.row_bytes() / WORD_BYTES, number, |out| {
        for decisions in decisions.chunks(8 / bits) {
            let codes =
                decisions.iter().enumerate().map(|(at, decision)| decision.code() << (at * bits));
            out.push(codes.fold(0, |byte, code| byte | code));
        }
    });
    Ok(())
}

/// Appends the SCORES of a row of regions. `regions` yields, for each region, the number of changed
/// pixels and then each score.
///
/// # Errors
/// Fails if there is no such row, if the number of regions or of scores is wrong, or if a score is
/// larger than a region of the design can have.
pub fn append_scores<S: IntoIterator<Item = u64>>(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    number: u32,
    row: u32,
    regions: impl Iterator<Item = S>,
) -> Result<(), PacketError> {
    let head = PacketFields::of_row(SCORES_TYPE, layout, row)?;
    let info = layout.info();
    let columns = if info.has_scores { info.columns.into() } else { 0 };
    let (mut regions, mut records, mut count) = (regions, Vec::new(), 0);
    for region in regions.by_ref().take(columns) {
        append_record(&mut records, layout, region)?;
        count += 1;
    }
    check_count("SCORES", "records", count + regions.count(), columns)?;
    append_packet(out, head, layout.scores_bytes() / WORD_BYTES, number, |out| out.extend(records));
    Ok(())
}

fn append_record(
    records: &mut Vec<u8>,
    layout: &PacketLayout,
    region: impl IntoIterator<Item = u64>,
) -> Result<(), PacketError> {
    let (start, expected) = (records.len(), layout.score_fields().count());
    let (mut region, mut count) = (region.into_iter(), 0);
    for ((max, bytes), value) in layout.score_fields().zip(region.by_ref().take(expected)) {
        let value = checked_field("score", value, 0..=max)?;
        records.resize(start + (records.len() - start).next_multiple_of(bytes), 0);
        records.extend(value.to_le_bytes().iter().take(bytes));
        count += 1;
    }
    check_count("SCORES", "numbers of a region", count + region.count(), expected)?;
    records.resize(start + layout.record_bytes(), 0);
    Ok(())
}

/// Appends the FLOW of a row of regions.
///
/// # Errors
/// Fails if there is no such row, if the design sends no displacements, if their number is not that
/// of the regions, or if the design cannot find one of them.
pub fn append_flow(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    number: u32,
    row: u32,
    displacements: &[Displacement],
) -> Result<(), PacketError> {
    let head = PacketFields::of_row(FLOW_TYPE, layout, row)?;
    let Some(radius) = layout.flow_radius() else {
        let (field, value, most) = ("type", FLOW_TYPE.into(), REGISTER_TYPE.into());
        return Err(PacketError::FieldOutOfRange { field, value, least: FRAME_TYPE.into(), most });
    };
    check_count("FLOW", "displacements", displacements.len(), layout.info().columns.into())?;
    if let Some(wrong) = displacements.iter().find(|one| one.largest_coordinate() > radius) {
        let Displacement { dx, dy } = *wrong;
        return Err(PacketError::DisplacementOutOfRange { dx, dy, radius });
    }
    append_packet(out, head, layout.flow_bytes() / WORD_BYTES, number, |out| {
        out.extend(displacements.iter().map(|one| (one.dx & 15 | one.dy << 4).cast_unsigned()));
    });
    Ok(())
}

/// Appends a REGION at a row and a column of regions.
///
/// # Errors
/// Fails if there is no such region, if the design does not send these flags, if the number of
/// values is wrong, or if a value is larger than a pixel of the design can be.
pub fn append_region(
    out: &mut Vec<u8>,
    layout: &PacketLayout,
    number: u32,
    (row, column): (u32, u32),
    (flags, values): (RegionFlags, &[u16]),
) -> Result<(), PacketError> {
    let row = checked_index("row", row, layout.rows())?;
    let column = checked_index("column", column, layout.columns())?;
    let raw = u64::from(layout.info().raw);
    checked_field("raw flag", flags.raw.into(), raw..=raw)?;
    checked_field("summary flag", flags.summary.into(), 0..=layout.has_periphery().into())?;
    check_count("REGION", "values", values.len(), layout.value_count(flags.summary))?;
    let most = layout.pixel_max();
    if let Some(&value) = values.iter().find(|&&value| value > most) {
        checked_field("value", value.into(), 0..=most.into())?;
    }
    let head = PacketFields { kind: REGION_TYPE, flags: flags.bits(), row, column };
    let words = layout.region_bytes(flags.summary) / WORD_BYTES;
    append_packet(out, head, words, number, |out| match layout.value_bytes() {
        1 => out.extend(values.iter().map(|value| value.to_le_bytes()[0])),
        _ => out.extend(values.iter().flat_map(|value| value.to_le_bytes())),
    });
    Ok(())
}

/// Appends the END of a frame.
///
/// # Errors
/// Fails if the number of dropped rows does not fit into its field.
pub fn append_end(out: &mut Vec<u8>, number: u32, end: EndPacket) -> Result<(), PacketError> {
    let dropped = end.regions_dropped > 0 || end.rows_dropped > 0;
    let row = checked_u16("dropped rows", end.rows_dropped.into())?;
    let head = PacketFields { kind: END_TYPE, flags: dropped.into(), row, column: 0 };
    append_packet(out, head, END_WORDS, number, |out| {
        let counts = u64::from(end.regions_sent) | u64::from(end.regions_dropped) << 32;
        out.extend(counts.to_le_bytes());
    });
    Ok(())
}

/// Appends a REGISTER, which belongs to no frame.
pub fn append_register(out: &mut Vec<u8>, register: RegisterPacket) {
    let flags = register.is_write.into();
    let head = PacketFields { kind: REGISTER_TYPE, flags, row: register.address, column: 0 };
    append_packet(out, head, REGISTER_WORDS, 0, |out| {
        out.extend(u64::from(register.value).to_le_bytes());
    });
}

/// The fields of a packet's first word, except for its length.
#[derive(Clone, Copy)]
struct PacketFields {
    kind: u8,
    flags: u8,
    row: u16,
    column: u16,
}

impl PacketFields {
    /// Makes the fields of a packet about a row of regions.
    fn of_row(kind: u8, layout: &PacketLayout, row: u32) -> Result<Self, PacketError> {
        let row = checked_index("row", row, layout.rows())?;
        Ok(Self { kind, flags: 0, row, column: layout.info().columns })
    }
}

/// Returns the number of a row or column if it is less than `count`.
fn checked_index(name: &'static str, number: u32, count: u32) -> Result<u16, PacketError> {
    checked_u16(name, checked_field(name, number.into(), 0..=u64::from(count).saturating_sub(1))?)
}

/// Fails if the number of values differs from the number in such a packet.
fn check_count(
    packet: &'static str,
    what: &'static str,
    found: usize,
    expected: usize,
) -> Result<(), PacketError> {
    let fits = found == expected;
    fits.then_some(()).ok_or(PacketError::ValueCountMismatch {
        packet,
        what,
        found,
        right: expected,
    })
}

/// Appends a packet of `words` words: the head, the payload that `append_payload` appends, padding
/// to whole words, and the tail.
fn append_packet(
    out: &mut Vec<u8>,
    head: PacketFields,
    words: usize,
    number: u32,
    append_payload: impl FnOnce(&mut Vec<u8>),
) {
    // No packet of a layout is longer.
    let length = u16::try_from(words).unwrap_or_else(|_| unreachable!("{words} words fit"));
    let first = u64::from(MARK)
        | u64::from(head.kind | head.flags << 4) << 8
        | u64::from(length) << 16
        | u64::from(head.row) << 32
        | u64::from(head.column) << 48;
    let start = out.len();
    out.extend(first.to_le_bytes());
    append_payload(out);
    debug_assert!(
        out.len() - start <= (words + 1 - HEAD_AND_TAIL_WORDS) * WORD_BYTES,
        "it carries too much"
    );
    out.resize(start + (words + 1 - HEAD_AND_TAIL_WORDS) * WORD_BYTES, 0);
    out.extend(number.to_le_bytes());
    let check = crc32fast::hash(&out[start..]);
    out.extend(check.to_le_bytes());
}

impl RegionDecision {
    /// Returns the bits of the decision in a ROW.
    fn code(self) -> u8 {
        u8::from(self.srs) | u8::from(self.trs) << 1 | u8::from(self.summary) << 2
    }
}
