// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame in every pixel depth that cameras need.

use std::collections::BTreeMap;

use foveate_engine::Engine;
use foveate_footage::{FootageError, SourceKind};
use foveate_frame::{ByteFrame, convert_depth};

use crate::ExploreError;

/// A frame in its own depth and in other depths.
pub(crate) struct FrameDepths<'a> {
    own: &'a ByteFrame,
    others: BTreeMap<u32, ByteFrame>,
}

impl<'a> FrameDepths<'a> {
    /// Converts the frame to all depths in `depths`, in bits per pixel.
    pub(crate) fn from_frame(
        own: &'a ByteFrame,
        depths: impl IntoIterator<Item = u32>,
    ) -> Result<Self, ExploreError> {
        let mut others = BTreeMap::new();
        for bits in depths {
            if bits != own.bits() && !others.contains_key(&bits) {
                others.insert(bits, at_depth(own, bits)?);
            }
        }
        Ok(Self { own, others })
    }

    /// Shows the frame to a camera in its depth. Every frame of a data set is a first frame, so the
    /// camera is reset before it.
    pub(crate) fn step_engine(
        &self,
        engine: &mut Engine,
        kind: SourceKind,
    ) -> Result<(), ExploreError> {
        if kind == SourceKind::Set {
            engine.reset();
        }
        let bits = engine.camera().pixel_bits();
        engine.step_byte_frame(self.others.get(&bits).unwrap_or(self.own))?;
        Ok(())
    }
}

fn at_depth(frame: &ByteFrame, bits: u32) -> Result<ByteFrame, ExploreError> {
    let (width, height, own) = (frame.width(), frame.height(), frame.bits());
    let words = frame.borrowed_pixels().to_words().into_iter();
    let pixels = words.map(|pixel| convert_depth(pixel, own, bits));
    let raster = if bits <= 8 {
        let bytes = pixels.map(|pixel| u8::try_from(pixel).expect("at most 8 bits")).collect();
        ByteFrame::from_bytes(width, height, bits, bytes)
    } else {
        ByteFrame::from_words(width, height, bits, pixels.collect())
    };
    Ok(raster.map_err(FootageError::from)?)
}
