// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame in every pixel depth that cameras need.

use std::collections::BTreeMap;

use foveate_engine::Engine;
use foveate_footage::{FootageError, Kind};
use foveate_frame::{Raster, convert_depth};

use crate::ExploreError;

/// A frame in its own depth and in other depths.
pub(crate) struct Depths<'a> {
    own: &'a Raster,
    others: BTreeMap<u32, Raster>,
}

impl<'a> Depths<'a> {
    /// Converts the frame to all depths in `depths`, in bits per pixel.
    pub(crate) fn of(
        own: &'a Raster,
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
    pub(crate) fn show(&self, engine: &mut Engine, kind: Kind) -> Result<(), ExploreError> {
        if kind == Kind::Set {
            engine.reset();
        }
        let bits = engine.camera().pixel_bits();
        engine.step_raster(self.others.get(&bits).unwrap_or(self.own))?;
        Ok(())
    }
}

fn at_depth(frame: &Raster, bits: u32) -> Result<Raster, ExploreError> {
    let (width, height, own) = (frame.width(), frame.height(), frame.bits());
    let words = frame.plane().to_words().into_iter();
    let pixels = words.map(|pixel| convert_depth(pixel, own, bits));
    let raster = if bits <= 8 {
        let bytes = pixels.map(|pixel| u8::try_from(pixel).expect("at most 8 bits")).collect();
        Raster::from_bytes(width, height, bits, bytes)
    } else {
        Raster::from_words(width, height, bits, pixels.collect())
    };
    Ok(raster.map_err(FootageError::from)?)
}
