// SPDX-License-Identifier: MIT OR Apache-2.0
//! The places of everything in the packets of a design: the lengths of the packets, the ranges
//! of their fields ([`PacketLayout`]), and the fields of the 64-bit words that all packets
//! consist of.

use crate::{FrameInfo, PacketError};
use foveate_camera::{Camera, IrrelevantRendering, Payload, SpatialFeature};
use foveate_design::Design;
use std::ops::RangeInclusive;

/// The version of the format, in every FRAME.
pub const VERSION: u16 = 1;
/// The second word of a FRAME, as bytes.
pub const MAGIC: [u8; 8] = *b"FOVEATE\n";
/// The first byte of every packet.
pub(crate) const MARK: u8 = 0xFA;
pub(crate) const WORD_BYTES: usize = 8;
pub(crate) const FRAME_WORDS: usize = 7;
pub(crate) const END_WORDS: usize = 3;
pub(crate) const REGISTER_WORDS: usize = 3;
/// The number of words around the payload of a packet: its head and its tail.
pub(crate) const HEAD_AND_TAIL_WORDS: usize = 2;

/// The properties of a design that determine its packets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PacketLayout {
    info: FrameInfo,
    /// The largest score of each feature.
    score_max: Vec<u64>,
    /// The radius of the search of `flow`; `None` for a design without `flow`.
    flow_radius: Option<u32>,
    /// True if the regions have classes, so that FRAMEs carry the version of their map.
    has_zones: bool,
}

impl PacketLayout {
    /// Makes the layout of a design's packets, with or without scores. Times count
    /// `ticks_per_second`.
    ///
    /// # Errors
    /// Fails if a size of the design or the length of one of its packets does not fit into its
    /// field, or if `ticks_per_second` is 0. The packets of every design that a configuration can
    /// describe fit.
    pub fn new(
        design: &Design,
        has_scores: bool,
        ticks_per_second: u32,
    ) -> Result<Self, PacketError> {
        let layout = Self::without_checks(design, has_scores, ticks_per_second)?;
        checked_field("ticks per second", ticks_per_second.into(), 1..=u32::MAX.into())?;
        let scores = if has_scores { layout.scores_bytes() } else { 0 };
        let flow = if layout.has_flow() { layout.flow_bytes() } else { 0 };
        for bytes in [layout.row_bytes(), layout.region_bytes(false), scores, flow] {
            checked_u16("length in words", (bytes / WORD_BYTES) as u64)?;
        }
        Ok(layout)
    }

    /// Makes the layout without a check of lengths and of the unit of time.
    fn without_checks(
        design: &Design,
        has_scores: bool,
        ticks_per_second: u32,
    ) -> Result<Self, PacketError> {
        let camera: &Camera = design;
        let info = FrameInfo {
            version: VERSION,
            fingerprint: fingerprint_number(design),
            ticks_per_second,
            width: checked_u16("width", camera.width().into())?,
            height: checked_u16("height", camera.height().into())?,
            columns: checked_u16("number of columns", camera.columns().into())?,
            rows: checked_u16("number of rows", camera.rows().into())?,
            side: checked_u8("side of a region", camera.region_size())?,
            pixel_bits: checked_u8("bits of a pixel", camera.pixel_bits())?,
            blocks: checked_u8(
                "number of blocks",
                camera.periphery().map_or(0, |periphery| periphery.blocks),
            )?,
            irrelevant: match camera.irrelevant() {
                IrrelevantRendering::Zero => 0,
                IrrelevantRendering::Hold => 1,
                IrrelevantRendering::Mean => 2,
            },
            raw: match camera.payload() {
                Payload::Raw => true,
                Payload::Denoised => false,
            },
            has_scores,
            first: false,
            map_version: 0,
            time: 0,
        };
        let score_max = camera.features().iter().map(|feature| feature.score_max());
        let flow_radius = camera.displacement_feature().and_then(SpatialFeature::radius);
        let (score_max, has_zones) = (score_max.collect(), camera.zones().is_some());
        Ok(Self { info, score_max, flow_radius, has_zones })
    }

    /// Returns the content of every FRAME of the design, in which `time` and `map_version` are 0
    /// and `first` is false.
    #[must_use]
    pub fn info(&self) -> &FrameInfo {
        &self.info
    }

    /// Returns the number of columns of regions.
    #[must_use]
    pub fn columns(&self) -> u32 {
        self.info.columns.into()
    }

    /// Returns the number of rows of regions.
    #[must_use]
    pub fn rows(&self) -> u32 {
        self.info.rows.into()
    }

    /// Returns the number of regions of a frame.
    pub(crate) fn regions(&self) -> usize {
        index(self.columns()) * index(self.rows())
    }

    /// Returns whether irrelevant regions send summaries.
    #[must_use]
    pub fn has_periphery(&self) -> bool {
        self.info.blocks > 0
    }

    /// Returns whether displacements are sent.
    #[must_use]
    pub fn has_flow(&self) -> bool {
        self.flow_radius.is_some()
    }

    /// Returns whether FRAMEs carry the version of a map of classes. In other designs it is
    /// always 0.
    #[must_use]
    pub fn has_zones(&self) -> bool {
        self.has_zones
    }

    /// Returns the largest version of a map of classes that a FRAME of the design can have.
    pub(crate) fn map_version_max(&self) -> u16 {
        if self.has_zones { u16::MAX } else { 0 }
    }

    /// Returns false if a FRAME is one of this design and has a version of a map of classes that
    /// the design cannot have. Another design may have zones.
    pub(crate) fn has_possible_map(&self, info: &FrameInfo) -> bool {
        info.fingerprint != self.info.fingerprint || info.map_version <= self.map_version_max()
    }

    /// Returns the radius of the search of `flow` in pixels; `None` for a design without `flow`.
    pub(crate) fn flow_radius(&self) -> Option<u32> {
        self.flow_radius
    }

    /// Returns the number of bytes of a pixel or mean.
    pub(crate) fn value_bytes(&self) -> usize {
        if self.info.pixel_bits <= 8 { 1 } else { 2 }
    }

    pub(crate) fn pixel_max(&self) -> u16 {
        u16::MAX >> 16u8.saturating_sub(self.info.pixel_bits)
    }

    /// Returns the number of bits that a ROW has for each region.
    pub(crate) fn decision_bits(&self) -> usize {
        if self.has_periphery() { 4 } else { 2 }
    }

    /// Returns the number of pixels of a region, or of means of a summary.
    #[must_use]
    pub fn value_count(&self, summary: bool) -> usize {
        let side = usize::from(if summary { self.info.blocks } else { self.info.side });
        side * side
    }

    /// Returns the number of bytes of a ROW.
    #[must_use]
    pub fn row_bytes(&self) -> usize {
        packet_bytes(index(self.columns()) * self.decision_bits(), 8 * WORD_BYTES)
    }

    /// Returns the number of bytes of a SCORES.
    #[must_use]
    pub fn scores_bytes(&self) -> usize {
        packet_bytes(index(self.columns()) * self.record_bytes(), WORD_BYTES)
    }

    /// Returns the number of bytes of a FLOW.
    #[must_use]
    pub fn flow_bytes(&self) -> usize {
        packet_bytes(index(self.columns()), WORD_BYTES)
    }

    /// Returns the number of bytes of a REGION with pixels or with means.
    #[must_use]
    pub fn region_bytes(&self, summary: bool) -> usize {
        packet_bytes(self.value_count(summary) * self.value_bytes(), WORD_BYTES)
    }

    /// Returns the number of bytes of a FRAME.
    #[must_use]
    pub fn frame_bytes(&self) -> usize {
        FRAME_WORDS * WORD_BYTES
    }

    /// Returns the number of bytes of an END.
    #[must_use]
    pub fn end_bytes(&self) -> usize {
        END_WORDS * WORD_BYTES
    }

    /// Returns the largest value and the number of bytes of each score of a region, changed pixels
    /// first.
    pub(crate) fn score_fields(&self) -> impl Iterator<Item = (u64, usize)> + '_ {
        let pixels = u64::try_from(self.value_count(false)).unwrap_or(u64::MAX);
        let field_bytes = |max: u64| match max {
            0..=0xFFFF => 2,
            0x1_0000..=0xFFFF_FFFF => 4,
            _ => 8,
        };
        let maxima = std::iter::once(pixels).chain(self.score_max.iter().copied());
        maxima.map(move |max| (max, field_bytes(max)))
    }

    /// Returns the number of bytes of the scores of a region. Each score is aligned to its own
    /// size, and the record ends at a word.
    pub(crate) fn record_bytes(&self) -> usize {
        let end =
            self.score_fields().fold(0usize, |at, (_, bytes)| at.next_multiple_of(bytes) + bytes);
        end.next_multiple_of(WORD_BYTES)
    }
}

/// Returns the number of bytes of a packet that carries `amount` units, of which `in_word` fill a
/// word.
fn packet_bytes(amount: usize, in_word: usize) -> usize {
    (amount.div_ceil(in_word) + HEAD_AND_TAIL_WORDS) * WORD_BYTES
}

/// Returns the fingerprint of a design, which is text, as the number that has these hexadecimal
/// digits.
fn fingerprint_number(design: &Design) -> u64 {
    let digits = design.fingerprint();
    u64::from_str_radix(&digits, 16).unwrap_or_else(|_| unreachable!("16 digits, not {digits}"))
}

/// Returns the word at the beginning of these bytes; `None` if there are fewer than eight.
pub(crate) fn word(bytes: &[u8]) -> Option<u64> {
    bytes.first_chunk().map(|bytes| u64::from_le_bytes(*bytes))
}

/// Returns sixteen bits of a word, from bit `from` on.
pub(crate) fn bits16(word: u64, from: u32) -> u16 {
    let [a, b, ..] = (word >> from).to_le_bytes();
    u16::from_le_bytes([a, b])
}

/// Returns eight bits of a word, from bit `from` on.
pub(crate) fn bits8(word: u64, from: u32) -> u8 {
    (word >> from).to_le_bytes()[0]
}

/// Returns 32 bits of a word, from bit `from` on.
pub(crate) fn bits32(word: u64, from: u32) -> u32 {
    let [a, b, c, d, ..] = (word >> from).to_le_bytes();
    u32::from_le_bytes([a, b, c, d])
}

/// Converts a number to an index. This is lossless, because `usize` has at least 32 bits on every
/// machine that can hold a frame.
pub(crate) const fn index(value: u32) -> usize {
    value as usize
}

pub(crate) fn checked_field(
    field: &'static str,
    value: u64,
    range: RangeInclusive<u64>,
) -> Result<u64, PacketError> {
    let (&least, &most) = (range.start(), range.end());
    range.contains(&value).then_some(value).ok_or(PacketError::FieldOutOfRange {
        field,
        value,
        least,
        most,
    })
}

/// Returns the number if a field of 16 bits can hold it.
pub(crate) fn checked_u16(name: &'static str, value: u64) -> Result<u16, PacketError> {
    let value = checked_field(name, value, 0..=u16::MAX.into())?;
    Ok(u16::try_from(value).unwrap_or(u16::MAX))
}

/// Returns the number if a field of 8 bits can hold it.
pub(crate) fn checked_u8(name: &'static str, value: u32) -> Result<u8, PacketError> {
    let value = checked_field(name, value.into(), 0..=u8::MAX.into())?;
    Ok(u8::try_from(value).unwrap_or(u8::MAX))
}
