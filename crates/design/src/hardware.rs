// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of a validated design: an organization with its own properties.

use crate::pipelined::PipelinedHardware;
use crate::raster::RasterHardware;
use crate::serial::SerialHardware;
use crate::{InterfaceKind, Organization, OrganizationConfig, Pipelining};

/// The hardware that computes a camera.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Hardware {
    /// One RPU per region.
    Pipelined(PipelinedHardware),
    /// Lanes that regions share, under one sequencer.
    Serial(SerialHardware),
    /// One core for all regions.
    Raster(RasterHardware),
}

impl Hardware {
    /// Returns the organization without its properties.
    #[must_use]
    pub fn organization(&self) -> Organization {
        match self {
            Self::Pipelined(_) => Organization::Pipelined,
            Self::Serial(_) => Organization::Serial,
            Self::Raster(_) => Organization::Raster,
        }
    }

    /// Returns the number of registers in the arithmetic.
    #[must_use]
    pub fn pipelining(&self) -> Pipelining {
        match self {
            Self::Pipelined(own) => own.pipelining,
            Self::Serial(own) => own.pipelining,
            Self::Raster(own) => own.pipelining,
        }
    }

    /// Returns true if the pixels of active regions leave.
    #[must_use]
    pub fn has_forwarding(&self) -> bool {
        match self {
            Self::Pipelined(_) | Self::Serial(_) => true,
            Self::Raster(own) => own.has_forwarding,
        }
    }

    /// Returns the interface by which the core is connected.
    #[must_use]
    pub fn interface_kind(&self) -> InterfaceKind {
        match self {
            Self::Pipelined(_) | Self::Serial(_) => InterfaceKind::Ports,
            Self::Raster(own) => own.interface_kind,
        }
    }

    /// Returns the organization with the keys that only it has.
    pub(crate) fn organization_config(&self) -> OrganizationConfig {
        match self {
            Self::Pipelined(_) => OrganizationConfig::Pipelined,
            Self::Serial(own) => OrganizationConfig::Serial(own.config()),
            Self::Raster(own) => OrganizationConfig::Raster(own.config()),
        }
    }
}
