// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packets as values, and their checks: only bytes that exactly match the layout are a packet.

use foveate_camera::Displacement;

use super::packet_layout::{bits8, bits16, bits32, index, word};
use crate::FrameInfo;
use crate::packet_layout::{
    END_WORDS, FRAME_WORDS, HEAD_AND_TAIL_WORDS, MAGIC, MARK, PacketLayout, REGISTER_WORDS,
    WORD_BYTES,
};

/// The decision of a region.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RegionDecision {
    /// The spatial relevance of the region.
    pub srs: bool,
    /// The temporal relevance of the region.
    pub trs: bool,
    /// True if the summary of the region is sent.
    pub summary: bool,
}

/// The content of a ROW packet: the decisions of a row of regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowPacket {
    /// The number of the row.
    pub row: u32,
    /// The decision of each region.
    pub decisions: Vec<RegionDecision>,
}

/// The content of a SCORES packet: the scores of a row of regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScoresPacket {
    /// The number of the row.
    pub row: u32,
    /// The number of changed pixels of each region.
    pub temporal_count: Vec<u32>,
    /// The scores, by feature and then by region.
    pub scores: Vec<Vec<u64>>,
}

/// The content of a FLOW packet: the displacements of a row of regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FlowPacket {
    /// The number of the row.
    pub row: u32,
    /// The displacement of each region.
    pub displacements: Vec<Displacement>,
}

/// The flags of a REGION packet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RegionFlags {
    /// True if the pixels, or the pixels that were averaged, are raw.
    pub raw: bool,
    /// True if the packet has means in place of pixels.
    pub summary: bool,
}

/// The content of a REGION packet: the pixels or means of a region.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegionPacket {
    /// The row of the region.
    pub row: u32,
    /// The column of the region.
    pub column: u32,
    /// The flags of the packet.
    pub flags: RegionFlags,
    /// The N x N pixels, or the q x q means, in row-major order.
    pub values: Vec<u16>,
}

/// The content of an END packet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EndPacket {
    /// The number of REGION packets of the frame.
    pub regions_sent: u32,
    /// The number of regions of the frame that the camera dropped.
    pub regions_dropped: u32,
    /// The number of ROW packets of the frame that the camera dropped.
    pub rows_dropped: u32,
}

/// The content of a REGISTER packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RegisterPacket {
    /// The address of the register in bytes.
    pub address: u16,
    /// True if the register is or was written, as opposed to read.
    pub is_write: bool,
    /// The value that is written, was written or was read; 0 in a command to read.
    pub value: u32,
}

/// A packet of a stream.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Packet {
    /// The beginning of a frame.
    Frame(FrameInfo),
    /// The decisions of a row of regions.
    Row(RowPacket),
    /// The scores of a row of regions.
    Scores(ScoresPacket),
    /// The pixels or means of a region.
    Region(RegionPacket),
    /// The end of a frame.
    End(EndPacket),
    /// A command to a board, or the answer to one. It belongs to no frame.
    Register(RegisterPacket),
    /// The displacements of a row of regions.
    Flow(FlowPacket),
}

/// The type number of a FRAME in the head of a packet. The other types follow.
pub(crate) const FRAME_TYPE: u8 = 1;
pub(crate) const ROW_TYPE: u8 = 2;
pub(crate) const SCORES_TYPE: u8 = 3;
pub(crate) const REGION_TYPE: u8 = 4;
pub(crate) const END_TYPE: u8 = 5;
pub(crate) const REGISTER_TYPE: u8 = 6;
pub(crate) const FLOW_TYPE: u8 = 7;

/// The first word of a packet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PacketHead {
    kind: u8,
    flags: u8,
    pub(crate) words: usize,
    row: u16,
    column: u16,
}

impl PacketHead {
    /// Parses the head at the beginning of these bytes; `None` if no packet can have it. Without a
    /// layout, only the head of a FRAME or of a REGISTER is accepted.
    pub(crate) fn of(bytes: &[u8], layout: Option<&PacketLayout>) -> Option<Self> {
        let word = word(bytes)?;
        let kind_and_flags = bits8(word, 8);
        let head = Self {
            kind: kind_and_flags & 0xF,
            flags: kind_and_flags >> 4,
            words: usize::from(bits16(word, 16)),
            row: bits16(word, 32),
            column: bits16(word, 48),
        };
        (bits8(word, 0) == MARK && head.is_possible(layout)).then_some(head)
    }

    /// Returns whether the length, the row, the column and the flags are possible for the type.
    fn is_possible(self, layout: Option<&PacketLayout>) -> bool {
        match self.kind {
            // The column depends on the design, which is in the payload.
            FRAME_TYPE => return self.flags <= 1 && self.words == FRAME_WORDS,
            REGISTER_TYPE => {
                return self.flags <= 1 && self.words == REGISTER_WORDS && self.column == 0;
            }
            _ => {}
        }
        let Some(layout) = layout else { return false };
        let (columns, rows) = (layout.info().columns, layout.info().rows);
        let is_row_head = |bytes| {
            self.flags == 0
                && self.row < rows
                && self.column == columns
                && self.words * WORD_BYTES == bytes
        };
        match self.kind {
            ROW_TYPE => is_row_head(layout.row_bytes()),
            SCORES_TYPE => layout.info().has_scores && is_row_head(layout.scores_bytes()),
            FLOW_TYPE => layout.has_flow() && is_row_head(layout.flow_bytes()),
            REGION_TYPE => {
                let flags = RegionFlags::of(self.flags);
                self.row < rows
                    && self.column < columns
                    && self.flags == flags.bits()
                    && flags.raw == layout.info().raw
                    && (layout.has_periphery() || !flags.summary)
                    && self.words * WORD_BYTES == layout.region_bytes(flags.summary)
            }
            END_TYPE => {
                self.flags <= 1 && self.words == END_WORDS && self.column == 0 && self.row <= rows
            }
            _ => false,
        }
    }
}

impl RegionFlags {
    pub(crate) fn of(bits: u8) -> Self {
        Self { raw: bits & 2 != 0, summary: bits & 4 != 0 }
    }

    pub(crate) fn bits(self) -> u8 {
        u8::from(self.raw) << 1 | u8::from(self.summary) << 2
    }
}

impl Packet {
    /// Parses these bytes, which begin with `head`, to a packet and the number of its frame; `None`
    /// if they are not exactly one packet.
    pub(crate) fn of(
        bytes: &[u8],
        head: PacketHead,
        layout: Option<&PacketLayout>,
    ) -> Option<(u32, Self)> {
        let (before, tail) = bytes.split_last_chunk::<WORD_BYTES>()?;
        let tail = u64::from_le_bytes(*tail);
        let (checked, _) = bytes.split_at_checked(bytes.len() - 4)?;
        if crc32fast::hash(checked) != bits32(tail, 32) {
            return None;
        }
        let payload = before.get(WORD_BYTES..)?;
        let packet = match (head.kind, layout) {
            (FRAME_TYPE, _) => Self::Frame(frame(head, payload, layout)?),
            (ROW_TYPE, Some(layout)) => Self::Row(row(head, payload, layout)?),
            (SCORES_TYPE, Some(layout)) => Self::Scores(scores(head, payload, layout)?),
            (REGION_TYPE, Some(layout)) => Self::Region(region(head, payload, layout)?),
            (END_TYPE, _) => Self::End(end(head, payload)?),
            (REGISTER_TYPE, _) => Self::Register(register(head, payload)?),
            (FLOW_TYPE, Some(layout)) => Self::Flow(flow(head, payload, layout)?),
            _ => return None,
        };
        debug_assert_eq!(bytes.len(), payload.len() + HEAD_AND_TAIL_WORDS * WORD_BYTES);
        Some((bits32(tail, 0), packet))
    }
}

/// Parses the payload of a FRAME. A FRAME of another version or design is accepted, too, so that
/// the reader can report it.
fn frame(head: PacketHead, payload: &[u8], layout: Option<&PacketLayout>) -> Option<FrameInfo> {
    if !payload.starts_with(&MAGIC) {
        return None;
    }
    let mut words = payload.chunks_exact(WORD_BYTES).skip(1).filter_map(word);
    let (fingerprint, time, size, rest) =
        (words.next()?, words.next()?, words.next()?, words.next()?);
    let info = FrameInfo {
        version: head.row,
        fingerprint,
        ticks_per_second: bits32(size, 0),
        width: bits16(size, 32),
        height: bits16(size, 48),
        columns: bits16(rest, 32),
        rows: bits16(rest, 48),
        side: bits8(rest, 0),
        pixel_bits: bits8(rest, 8),
        blocks: bits8(rest, 16),
        irrelevant: bits8(rest, 24) & 0xF,
        raw: rest >> 28 & 1 == 1,
        has_scores: rest >> 29 & 1 == 1,
        first: head.flags == 1,
        map_version: head.column,
        time,
    };
    let has_possible_map = layout.is_none_or(|layout| layout.has_possible_map(&info));
    (info.ticks_per_second > 0 && rest >> 30 & 3 == 0 && has_possible_map).then_some(info)
}

fn row(head: PacketHead, payload: &[u8], layout: &PacketLayout) -> Option<RowPacket> {
    let bits = layout.decision_bits();
    let code = |region: usize| {
        let at = region * bits;
        Some(payload.get(at / 8)? >> (at % 8) & if bits == 2 { 3 } else { 15 })
    };
    let decisions = (0..index(layout.columns())).map(|region| {
        let code = code(region)?;
        // Only an irrelevant region sends a summary.
        let possible = code & 0b1000 == 0 && code & 0b101 != 0b101;
        possible.then_some(RegionDecision {
            srs: code & 1 != 0,
            trs: code & 2 != 0,
            summary: code & 4 != 0,
        })
    });
    Some(RowPacket { row: head.row.into(), decisions: decisions.collect::<Option<_>>()? })
}

fn scores(head: PacketHead, payload: &[u8], layout: &PacketLayout) -> Option<ScoresPacket> {
    let columns = index(layout.columns());
    let (mut temporal_count, mut scores) = (
        Vec::with_capacity(columns),
        vec![Vec::with_capacity(columns); layout.score_fields().count() - 1],
    );
    for record in payload.chunks_exact(layout.record_bytes()) {
        let mut at = 0usize;
        for (number, (max, bytes)) in layout.score_fields().enumerate() {
            at = at.next_multiple_of(bytes);
            let mut value = [0; WORD_BYTES];
            value.get_mut(..bytes)?.copy_from_slice(record.get(at..at + bytes)?);
            at += bytes;
            let value = Some(u64::from_le_bytes(value)).filter(|&value| value <= max)?;
            match number.checked_sub(1) {
                None => temporal_count.push(u32::try_from(value).ok()?),
                Some(feature) => scores.get_mut(feature)?.push(value),
            }
        }
    }
    Some(ScoresPacket { row: head.row.into(), temporal_count, scores })
}

fn flow(head: PacketHead, payload: &[u8], layout: &PacketLayout) -> Option<FlowPacket> {
    let (bytes, radius) = (payload.iter().take(index(layout.columns())), layout.flow_radius()?);
    let displacements = bytes.map(|byte| {
        // A shift to the left and one to the right extend the sign of four bits.
        let bits = byte.cast_signed();
        let displacement = Displacement { dx: bits << 4 >> 4, dy: bits >> 4 };
        (displacement.largest_coordinate() <= radius).then_some(displacement)
    });
    Some(FlowPacket { row: head.row.into(), displacements: displacements.collect::<Option<_>>()? })
}

fn region(head: PacketHead, payload: &[u8], layout: &PacketLayout) -> Option<RegionPacket> {
    let flags = RegionFlags::of(head.flags);
    let count = layout.value_count(flags.summary);
    let values: Vec<u16> = match layout.value_bytes() {
        1 => payload.iter().take(count).map(|&value| value.into()).collect(),
        _ => payload.as_chunks().0.iter().take(count).map(|&two| u16::from_le_bytes(two)).collect(),
    };
    let fits = values.iter().all(|&value| value <= layout.pixel_max());
    let (row, column) = (head.row.into(), head.column.into());
    fits.then_some(RegionPacket { row, column, flags, values })
}

fn end(head: PacketHead, payload: &[u8]) -> Option<EndPacket> {
    let counts = word(payload)?;
    let end = EndPacket {
        regions_sent: bits32(counts, 0),
        regions_dropped: bits32(counts, 32),
        rows_dropped: head.row.into(),
    };
    let dropped = end.regions_dropped > 0 || end.rows_dropped > 0;
    (dropped == (head.flags == 1)).then_some(end)
}

fn register(head: PacketHead, payload: &[u8]) -> Option<RegisterPacket> {
    let value = bits32(word(payload)?, 0);
    Some(RegisterPacket { address: head.row, is_write: head.flags == 1, value })
}
