// SPDX-License-Identifier: MIT OR Apache-2.0
//! Views of a design whose organization is known.
//!
//! The properties of one organization are methods of a [`DesignWithHardware`] its hardware. So the
//! lanes of a pipelined array or the frame store of a serial array cannot be asked for.

use std::ops::Deref;

use crate::pipelined::PipelinedHardware;
use crate::raster::RasterHardware;
use crate::serial::SerialHardware;
use crate::{Design, Hardware};

/// A design together with the properties of its hardware. It dereferences to the design.
#[derive(Debug)]
pub struct DesignWithHardware<'a, H> {
    design: &'a Design,
    own_hardware: &'a H,
}

/// A design with one RPU per region.
pub type PipelinedDesign<'a> = DesignWithHardware<'a, PipelinedHardware>;
/// A design with lanes that regions share.
pub type SerialDesign<'a> = DesignWithHardware<'a, SerialHardware>;
/// A design with one core for all regions.
pub type RasterDesign<'a> = DesignWithHardware<'a, RasterHardware>;

impl<H> Clone for DesignWithHardware<'_, H> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<H> Copy for DesignWithHardware<'_, H> {}

impl<H> Deref for DesignWithHardware<'_, H> {
    type Target = Design;

    fn deref(&self) -> &Design {
        self.design
    }
}

impl<'a, H> DesignWithHardware<'a, H> {
    /// Returns the design without the type of its hardware.
    #[must_use]
    pub fn design(self) -> &'a Design {
        self.design
    }

    /// Returns the properties of the hardware. Those of its lone unit are equal.
    #[must_use]
    pub fn own_hardware(self) -> &'a H {
        self.own_hardware
    }
}

impl Design {
    /// Returns a view of this design with its hardware. `own` must be the content of
    /// [`Design::hardware`].
    #[must_use]
    pub fn with_hardware<'a, H>(&'a self, own: &'a H) -> DesignWithHardware<'a, H> {
        DesignWithHardware { design: self, own_hardware: own }
    }

    /// Returns a view of this design if it is pipelined, else `None`.
    #[must_use]
    pub fn as_pipelined(&self) -> Option<PipelinedDesign<'_>> {
        match self.hardware() {
            Hardware::Pipelined(own) => Some(self.with_hardware(own)),
            Hardware::Serial(_) | Hardware::Raster(_) => None,
        }
    }

    /// Returns a view of this design if it is serial, else `None`.
    #[must_use]
    pub fn as_serial(&self) -> Option<SerialDesign<'_>> {
        match self.hardware() {
            Hardware::Serial(own) => Some(self.with_hardware(own)),
            Hardware::Pipelined(_) | Hardware::Raster(_) => None,
        }
    }

    /// Returns a view of this design if it is a raster core, else `None`.
    #[must_use]
    pub fn as_raster(&self) -> Option<RasterDesign<'_>> {
        match self.hardware() {
            Hardware::Raster(own) => Some(self.with_hardware(own)),
            Hardware::Pipelined(_) | Hardware::Serial(_) => None,
        }
    }

    /// Returns the number of regions that share a unit, one after the other: the fold of a serial
    /// array, else 1.
    #[must_use]
    pub fn slots(&self) -> u32 {
        match self.hardware() {
            Hardware::Serial(own) => own.fold,
            Hardware::Pipelined(_) | Hardware::Raster(_) => 1,
        }
    }
}
