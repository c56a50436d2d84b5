// SPDX-License-Identifier: MIT OR Apache-2.0
//! The values of the words that leave: pixels of the engine's last frame, or copies of earlier
//! ones.

use std::ops::Range;

use foveate_engine::Engine;
use foveate_pixels::FramePixels;

use crate::SentKind;

/// The values that regions send.
#[derive(Clone, Copy, Debug)]
pub struct SentValues<'a> {
    word_pixels: u32,
    source: ValueSource<'a>,
}

#[derive(Clone, Copy, Debug)]
enum ValueSource<'a> {
    /// The values are those of the engine's last frame, whose raw pixels are `raw`.
    LastFrame { engine: &'a Engine, raw: FramePixels<'a> },
    /// The values of a region were copied.
    Copy(&'a [u16]),
}

impl<'a> SentValues<'a> {
    pub(crate) fn of_last_frame(engine: &'a Engine, raw: FramePixels<'a>, word: u32) -> Self {
        Self { word_pixels: word, source: ValueSource::LastFrame { engine, raw } }
    }

    /// Returns the values of a region that were copied.
    pub(crate) fn copied(values: &'a [u16], word: u32) -> Self {
        Self { word_pixels: word, source: ValueSource::Copy(values) }
    }

    /// Appends all values that a region sends: its pixels in row-major order, or its means.
    pub(crate) fn append_region(&self, region: u32, values: &mut Vec<u16>) {
        match self.source {
            ValueSource::Copy(copied) => values.extend_from_slice(copied),
            ValueSource::LastFrame { engine, raw } => engine.sent_values(raw, region, values),
        }
    }

    pub(crate) fn append_words(
        &self,
        kind: SentKind,
        region: u32,
        words: Range<u32>,
        values: &mut Vec<u16>,
    ) {
        let size = match kind {
            SentKind::Pixels => self.word_pixels,
            SentKind::Means => 1,
        };
        let start = values.len();
        self.append_region(region, values);
        values.truncate(start + (words.end * size) as usize);
        values.drain(start..start + (words.start * size) as usize);
    }
}

/// The pixels of a frame that is kept.
#[derive(Clone, Debug)]
pub(crate) enum KeptPixels {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
}

impl KeptPixels {
    pub(crate) fn copy_of(pixels: FramePixels<'_>) -> Self {
        match pixels {
            FramePixels::Bytes(pixels) => Self::Bytes(pixels.to_vec()),
            FramePixels::Words(pixels) => Self::Words(pixels.to_vec()),
        }
    }

    pub(crate) fn borrow(&self) -> FramePixels<'_> {
        match self {
            Self::Bytes(pixels) => FramePixels::Bytes(pixels),
            Self::Words(pixels) => FramePixels::Words(pixels),
        }
    }
}
