// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of a validated design: an organization with what only it has.
//!
//! What belongs to one organization is asked of a [`DesignOn`] that hardware. Nobody can ask a pipelined array for
//! its lanes, or a serial one for its frame store.

use std::ops::Deref;

use crate::pipelined::Pipelined;
use crate::raster::Raster;
use crate::rules::Rules;
use crate::serial::Serial;
use crate::{Design, HardwareConfig, Organization, Pipelining};

/// What computes a camera.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Hardware {
    /// One RPU per region.
    Pipelined(Pipelined),
    /// Lanes that regions share, under one sequencer.
    Serial(Serial),
    /// One core for all regions.
    Raster(Raster),
}

impl Hardware {
    /// The organization without what it has.
    #[must_use]
    pub fn organization(&self) -> Organization {
        match self {
            Self::Pipelined(_) => Organization::Pipelined,
            Self::Serial(_) => Organization::Serial,
            Self::Raster(_) => Organization::Raster,
        }
    }

    /// How finely the arithmetic is cut by registers.
    #[must_use]
    pub fn pipelining(&self) -> Pipelining {
        match self {
            Self::Pipelined(own) => own.pipelining,
            Self::Serial(own) => own.pipelining,
            Self::Raster(own) => own.pipelining,
        }
    }

    /// Whether the pixels of active regions leave.
    #[must_use]
    pub fn forwards(&self) -> bool {
        match self {
            Self::Pipelined(_) | Self::Serial(_) => true,
            Self::Raster(own) => own.forwards,
        }
    }

    /// `[hardware]`, without what every organization has.
    pub(crate) fn config(&self) -> HardwareConfig {
        match self {
            Self::Pipelined(own) => own.config(),
            Self::Serial(own) => own.config(),
            Self::Raster(own) => own.config(),
        }
    }
}

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

    /// What every organization answers.
    pub(crate) fn rules(&self) -> Box<dyn Rules + '_> {
        match self.hardware() {
            Hardware::Pipelined(own) => Box::new(self.on(own)),
            Hardware::Serial(own) => Box::new(self.on(own)),
            Hardware::Raster(own) => Box::new(self.on(own)),
        }
    }
}
