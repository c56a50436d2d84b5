// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame in every pixel depth that cameras need.

use std::collections::BTreeMap;

use foveate_engine::{Engine, FrameOutcome};
use foveate_pixels::{ByteFrame, convert_depth};

use crate::playback::{PlaybackError, PlayedFrame};

/// A frame in its own depth and in other depths.
#[derive(Debug)]
pub struct FrameDepths<'a> {
    own: &'a PlayedFrame,
    others: BTreeMap<u32, ByteFrame>,
}

impl<'a> FrameDepths<'a> {
    /// Converts the frame to all depths in `depths`, in bits per pixel.
    ///
    /// # Errors
    /// Fails if a depth is out of range.
    pub fn from_frame(
        own: &'a PlayedFrame,
        depths: impl IntoIterator<Item = u32>,
    ) -> Result<Self, PlaybackError> {
        Self::from_disturbed(own, None, depths)
    }

    /// Does the same with other pixels in place of the frame's, if there are any.
    ///
    /// # Errors
    /// Fails if a depth is out of range.
    pub fn from_disturbed(
        own: &'a PlayedFrame,
        disturbed: Option<&ByteFrame>,
        depths: impl IntoIterator<Item = u32>,
    ) -> Result<Self, PlaybackError> {
        let mut others = BTreeMap::new();
        let shown = disturbed.unwrap_or(&own.frame);
        for bits in depths {
            if bits != shown.bits() && !others.contains_key(&bits) {
                others.insert(bits, at_depth(shown, bits)?);
            }
        }
        others.extend(disturbed.map(|frame| (frame.bits(), frame.clone())));
        Ok(Self { own, others })
    }

    /// Shows the frame to a camera in its depth, as [`PlayedFrame::show_to`] does.
    ///
    /// # Errors
    /// Fails if the frame does not have the camera's size, or was not converted to its depth.
    pub fn show_to<'e>(&self, engine: &'e mut Engine) -> Result<&'e FrameOutcome, PlaybackError> {
        let bits = engine.camera().pixel_bits();
        self.own.show_pixels_to(engine, self.frame_at(bits))
    }

    /// Returns the frame with so many bits per pixel, or in its own depth if it was not converted
    /// to this one.
    #[must_use]
    pub fn frame_at(&self, bits: u32) -> &ByteFrame {
        self.others.get(&bits).unwrap_or(&self.own.frame)
    }
}

fn at_depth(frame: &ByteFrame, bits: u32) -> Result<ByteFrame, PlaybackError> {
    let (width, height, own) = (frame.width(), frame.height(), frame.bits());
    let words = frame.borrowed_pixels().to_words().into_iter();
    let pixels = words.map(|pixel| convert_depth(pixel, own, bits));
    let converted = if bits <= 8 {
        let bytes = pixels.map(|pixel| u8::try_from(pixel).expect("at most 8 bits")).collect();
        ByteFrame::from_bytes(width, height, bits, bytes)
    } else {
        ByteFrame::from_words(width, height, bits, pixels.collect())
    };
    Ok(converted?)
}
