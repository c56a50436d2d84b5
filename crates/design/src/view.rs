// SPDX-License-Identifier: MIT OR Apache-2.0
//! A design whose hardware is known.
//!
//! What belongs to one organization is asked of a [`DesignOn`] that hardware. Nobody can ask a pipelined array for
//! its lanes, or a serial one for its frame store.

use std::ops::Deref;

use crate::pipelined::Pipelined;
use crate::raster::Raster;
use crate::serial::Serial;
use crate::{Design, Hardware};

/// A design and its hardware, when it is known which that is. It answers every question that the design answers.
#[derive(Debug)]
pub struct DesignOn<'a, H> {
    design: &'a Design,
    own: &'a H,
}

/// A design whose array has one RPU per region.
pub type PipelinedDesign<'a> = DesignOn<'a, Pipelined>;
/// A design whose array has lanes that regions share.
pub type SerialDesign<'a> = DesignOn<'a, Serial>;
/// A design that is one core for all regions.
pub type RasterDesign<'a> = DesignOn<'a, Raster>;

impl<H> Clone for DesignOn<'_, H> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<H> Copy for DesignOn<'_, H> {}

impl<H> Deref for DesignOn<'_, H> {
    type Target = Design;

    fn deref(&self) -> &Design {
        self.design
    }
}

impl<'a, H> DesignOn<'a, H> {
    /// The design, whatever its hardware.
    #[must_use]
    pub fn design(self) -> &'a Design {
        self.design
    }

    /// Its hardware; that of its lone unit is equal.
    #[must_use]
    pub fn own(self) -> &'a H {
        self.own
    }
}

impl Design {
    /// This design on its hardware, `own`, which is that of [`Design::hardware`].
    #[must_use]
    pub fn on<'a, H>(&'a self, own: &'a H) -> DesignOn<'a, H> {
        DesignOn { design: self, own }
    }

    /// This design if it is pipelined.
    #[must_use]
    pub fn pipelined(&self) -> Option<PipelinedDesign<'_>> {
        match self.hardware() {
            Hardware::Pipelined(own) => Some(self.on(own)),
            Hardware::Serial(_) | Hardware::Raster(_) => None,
        }
    }

    /// This design if it is serial.
    #[must_use]
    pub fn serial(&self) -> Option<SerialDesign<'_>> {
        match self.hardware() {
            Hardware::Serial(own) => Some(self.on(own)),
            Hardware::Pipelined(_) | Hardware::Raster(_) => None,
        }
    }

    /// This design if it is a raster core.
    #[must_use]
    pub fn raster(&self) -> Option<RasterDesign<'_>> {
        match self.hardware() {
            Hardware::Raster(own) => Some(self.on(own)),
            Hardware::Pipelined(_) | Hardware::Serial(_) => None,
        }
    }

    /// Regions that share a unit, one after the other: the fold of a serial array, else 1.
    #[must_use]
    pub fn slots(&self) -> u32 {
        match self.hardware() {
            Hardware::Serial(own) => own.fold,
            Hardware::Pipelined(_) | Hardware::Raster(_) => 1,
        }
    }
}
