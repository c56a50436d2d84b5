// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conversion of samples, as a pipe or a file has them, to a frame. 8-bit luma for a design of
//! 8 bits is not copied; all other samples are converted in one pass.

use foveate_pixels::{ByteFrame, FrameError, convert_depth, luma};

use crate::bayer::{BayerPattern, luma_of_mosaic};
use crate::luma_range::expanded;

/// The layout of the samples of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SampleLayout {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// The number of bits per sample. Above 8 bits, samples are words.
    pub(crate) depth: u32,
    /// True if a pixel has red, green and blue samples instead of one.
    pub(crate) is_colour: bool,
    /// True if words have their high byte first.
    pub(crate) is_big_endian: bool,
    /// True if luma has the narrow range, of 16 to 235 of 8 bits, and is expanded. Colours have all
    /// values.
    pub(crate) is_expanded: bool,
}

impl SampleLayout {
    /// Makes the layout of one sample per pixel with the low byte first.
    pub(crate) fn luma(width: u32, height: u32, depth: u32) -> Self {
        Self { width, height, depth, is_colour: false, is_big_endian: false, is_expanded: false }
    }

    /// Returns the number of bytes of a frame.
    pub(crate) fn bytes(self) -> usize {
        let channels = if self.is_colour { 3 } else { 1 };
        self.width as usize * self.height as usize * channels * if self.depth > 8 { 2 } else { 1 }
    }

    /// Makes the frame with `bits` bits per pixel. Samples above the largest value of their depth
    /// are limited to it.
    pub(crate) fn byte_frame(self, bytes: Vec<u8>, bits: u32) -> Result<ByteFrame, FrameError> {
        let Self { width, height, depth, is_colour: colour, is_expanded, .. } = self;
        if depth == bits && depth == 8 && !colour && !is_expanded {
            return ByteFrame::from_bytes(width, height, bits, bytes);
        }
        let max = u16::MAX >> (16 - depth);
        let words = bytes.chunks_exact(2).map(|pair| self.word(pair).min(max));
        let flat = bytes.iter().map(|&byte| u16::from(byte).min(max));
        let pixel_of = |value: u16| {
            let value = if is_expanded { expanded(value, depth) } else { value };
            convert_depth(value, depth, bits)
        };
        let pixels = match (colour, depth > 8) {
            (false, false) => {
                let table: Vec<u16> =
                    (0..=u8::MAX).map(|byte| pixel_of(max.min(byte.into()))).collect();
                bytes.iter().map(|&byte| table[usize::from(byte)]).collect()
            }
            (false, true) => words.map(pixel_of).collect(),
            (true, false) => luma_of_colours(flat, depth, bits),
            (true, true) => luma_of_colours(words, depth, bits),
        };
        ByteFrame::from_words(width, height, bits, pixels)
    }

    /// Makes the frame of a mosaic, whose pixels are single samples, with `bits` bits per pixel.
    pub(crate) fn frame_of_mosaic(
        self,
        bytes: &[u8],
        pattern: BayerPattern,
        bits: u32,
    ) -> Result<ByteFrame, FrameError> {
        let max = u16::MAX >> (16 - self.depth);
        let samples: Vec<u16> = match self.depth > 8 {
            true => bytes.chunks_exact(2).map(|pair| self.word(pair).min(max)).collect(),
            false => bytes.iter().map(|&byte| u16::from(byte).min(max)).collect(),
        };
        let luma = luma_of_mosaic(&samples, self.width as usize, pattern);
        let pixels = luma.into_iter().map(|value| convert_depth(value, self.depth, bits)).collect();
        ByteFrame::from_words(self.width, self.height, bits, pixels)
    }

    /// Returns the word of two bytes.
    fn word(self, pair: &[u8]) -> u16 {
        match self.is_big_endian {
            true => u16::from_be_bytes([pair[0], pair[1]]),
            false => u16::from_le_bytes([pair[0], pair[1]]),
        }
    }
}

fn luma_of_colours(mut samples: impl Iterator<Item = u16>, depth: u32, bits: u32) -> Vec<u16> {
    let mut pixels = Vec::with_capacity(samples.size_hint().0 / 3);
    while let (Some(red), Some(green), Some(blue)) =
        (samples.next(), samples.next(), samples.next())
    {
        pixels.push(convert_depth(luma(red, green, blue), depth, bits));
    }
    pixels
}
