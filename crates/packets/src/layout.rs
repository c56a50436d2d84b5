// SPDX-License-Identifier: MIT OR Apache-2.0
//! How long the packets of a design are, and what their fields may be.

use foveate_design::{Camera, Design, Irrelevant, Payload};

use crate::word::{field, index, narrow, small};
use crate::{FrameInfo, PacketError};

/// Version of the format, in every FRAME.
pub const VERSION: u16 = 1;
/// The second word of a FRAME, as bytes.
pub const MAGIC: [u8; 8] = *b"FOVEATE\n";
/// The first byte of every packet.
pub(crate) const MARK: u8 = 0xFA;
/// Bytes of a word.
pub(crate) const WORD: usize = 8;
/// Words of a FRAME, of an END and of a REGISTER.
pub(crate) const FRAME_WORDS: usize = 7;
pub(crate) const END_WORDS: usize = 3;
pub(crate) const REGISTER_WORDS: usize = 3;
/// Words around what a packet carries: head and tail.
pub(crate) const AROUND: usize = 2;

/// What follows from a design for its packets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    info: FrameInfo,
    /// Largest score of each feature.
    score_max: Vec<u64>,
}

impl Layout {
    /// The packets of a design, with or without scores, whose times count `ticks_per_second`.
    ///
    /// # Errors
    /// When a size of the design or the length of one of its packets does not fit into its field, and when there is no tick in
    /// a second. The packets of every design for frames of a configuration fit.
    pub fn new(
        design: &Design,
        has_scores: bool,
        ticks_per_second: u32,
    ) -> Result<Self, PacketError> {
        let layout = Self::of(design, has_scores, ticks_per_second)?;
        field("ticks per second", ticks_per_second.into(), 1..=u32::MAX.into())?;
        let scores = if has_scores { layout.scores_bytes() } else { 0 };
        for bytes in [layout.row_bytes(), layout.region_bytes(false), scores] {
            narrow("length in words", (bytes / WORD) as u64)?;
        }
        Ok(layout)
    }

    /// The same without a look at lengths.
    fn of(design: &Design, has_scores: bool, ticks_per_second: u32) -> Result<Self, PacketError> {
        let camera: &Camera = design;
        let info = FrameInfo {
            version: VERSION,
            fingerprint: fingerprint(design),
            ticks_per_second,
            width: narrow("width", camera.width().into())?,
            height: narrow("height", camera.height().into())?,
            columns: narrow("number of columns", camera.columns().into())?,
            rows: narrow("number of rows", camera.rows().into())?,
            side: small("side of a region", camera.region_size())?,
            pixel_bits: small("bits of a pixel", camera.pixel_bits())?,
            blocks: small("number of blocks", camera.periphery().map_or(0, |own| own.blocks))?,
            irrelevant: match camera.irrelevant() {
                Irrelevant::Zero => 0,
                Irrelevant::Hold => 1,
                Irrelevant::Mean => 2,
            },
            raw: match camera.payload() {
                Payload::Raw => true,
                Payload::Denoised => false,
            },
            has_scores,
            first: false,
            time: 0,
        };
        let score_max = camera.features().iter().map(|feature| feature.score_max());
        Ok(Self { info, score_max: score_max.collect() })
    }

    /// What every FRAME of the design says, time and first left open.
    #[must_use]
    pub fn info(&self) -> &FrameInfo {
        &self.info
    }

    /// Regions side by side.
    #[must_use]
    pub fn columns(&self) -> u32 {
        self.info.columns.into()
    }

    /// Regions one below the other.
    #[must_use]
    pub fn rows(&self) -> u32 {
        self.info.rows.into()
    }

    /// Regions of a frame.
    pub(crate) fn regions(&self) -> usize {
        index(self.columns()) * index(self.rows())
    }

    /// Whether irrelevant regions send summaries.
    #[must_use]
    pub fn has_periphery(&self) -> bool {
        self.info.blocks > 0
    }

    /// Bytes of a pixel or mean.
    pub(crate) fn lane(&self) -> usize {
        if self.info.pixel_bits <= 8 { 1 } else { 2 }
    }

    /// Largest pixel.
    pub(crate) fn pixel_max(&self) -> u16 {
        u16::MAX >> 16u8.saturating_sub(self.info.pixel_bits)
    }

    /// Bits that a ROW has for each region.
    pub(crate) fn decision_bits(&self) -> usize {
        if self.has_periphery() { 4 } else { 2 }
    }

    /// Pixels of a region, or means of a summary.
    #[must_use]
    pub fn values(&self, summary: bool) -> usize {
        let side = usize::from(if summary { self.info.blocks } else { self.info.side });
        side * side
    }

    /// Bytes of a ROW.
    #[must_use]
    pub fn row_bytes(&self) -> usize {
        packet(index(self.columns()) * self.decision_bits(), 8 * WORD)
    }

    /// Bytes of a SCORES.
    #[must_use]
    pub fn scores_bytes(&self) -> usize {
        packet(index(self.columns()) * self.record(), WORD)
    }

    /// Bytes of a REGION with pixels or with means.
    #[must_use]
    pub fn region_bytes(&self, summary: bool) -> usize {
        packet(self.values(summary) * self.lane(), WORD)
    }

    /// Bytes of a FRAME.
    #[must_use]
    pub fn frame_bytes(&self) -> usize {
        FRAME_WORDS * WORD
    }

    /// Bytes of an END.
    #[must_use]
    pub fn end_bytes(&self) -> usize {
        END_WORDS * WORD
    }

    /// The scores of a region: largest value and bytes of each, changed pixels first.
    pub(crate) fn scores(&self) -> impl Iterator<Item = (u64, usize)> + '_ {
        let pixels = u64::try_from(self.values(false)).unwrap_or(u64::MAX);
        let lane = |max: u64| match max {
            0..=0xFFFF => 2,
            0x1_0000..=0xFFFF_FFFF => 4,
            _ => 8,
        };
        let all = std::iter::once(pixels).chain(self.score_max.iter().copied());
        all.map(move |max| (max, lane(max)))
    }

    /// Bytes of the scores of a region: each lies at a multiple of its own size, all end with a word.
    pub(crate) fn record(&self) -> usize {
        let end = self.scores().fold(0usize, |at, (_, bytes)| at.next_multiple_of(bytes) + bytes);
        end.next_multiple_of(WORD)
    }
}

/// Bytes of a packet that carries `amount` units, of which so many fill a word.
fn packet(amount: usize, in_word: usize) -> usize {
    (amount.div_ceil(in_word) + AROUND) * WORD
}

/// The fingerprint of a design as a number: its hexadecimal digits.
fn fingerprint(design: &Design) -> u64 {
    let digits = design.fingerprint();
    u64::from_str_radix(&digits, 16).unwrap_or_else(|_| unreachable!("16 digits, not {digits}"))
}
