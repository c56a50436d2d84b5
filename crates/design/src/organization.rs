// SPDX-License-Identifier: MIT OR Apache-2.0
//! The unit, the timing and the ports of a design.
//!
//! Each organization implements [`crate::rules::OrganizationRules`] in its own module, which
//! defines these properties.

use crate::rules::{ArrayUnit, OrganizationRules};
use crate::{CoreInterface, Design, DesignTiming, Hardware, Organization, Port};

impl Organization {
    /// Returns the name of one unit of the array, such as "RPU".
    #[must_use]
    pub fn unit_name(self) -> &'static str {
        match self {
            Self::Pipelined => "RPU",
            Self::Serial => "lane",
            Self::Raster => "core",
        }
    }

    /// Returns true if regions can share a unit, so that `hardware.fold` may be more than 1.
    #[must_use]
    pub fn has_folding(self) -> bool {
        match self {
            Self::Serial => true,
            Self::Pipelined | Self::Raster => false,
        }
    }
}

impl Design {
    /// Returns the unit that the array repeats.
    #[must_use]
    pub fn unit(&self) -> ArrayUnit {
        self.rules().unit()
    }

    /// Returns the design that module `rpu` belongs to: this design if the RPU is a part of its
    /// array, else the design of an array with one unit, whose frame may be wider than a
    /// configuration allows.
    #[must_use]
    pub fn lone_unit(&self) -> Self {
        self.rules().lone_unit()
    }

    /// Returns the timing of the design.
    #[must_use]
    pub fn timing(&self) -> DesignTiming {
        self.rules().timing()
    }

    /// Returns the interface of module `rpu`.
    #[must_use]
    pub fn rpu_interface(&self) -> CoreInterface {
        self.rules().rpu_interface()
    }

    /// Returns the interface of module `rcm`.
    #[must_use]
    pub fn rcm_interface(&self) -> CoreInterface {
        self.rules().rcm_interface()
    }

    /// Returns the ports of module `rpu`, inputs first.
    #[must_use]
    pub fn rpu_ports(&self) -> Vec<Port> {
        self.rpu_interface().ports()
    }

    /// Returns the ports of module `rcm`, inputs first.
    #[must_use]
    pub fn rcm_ports(&self) -> Vec<Port> {
        self.rcm_interface().ports()
    }

    /// Returns the implementation of the organization of this design.
    fn rules(&self) -> Box<dyn OrganizationRules + '_> {
        match self.hardware() {
            Hardware::Pipelined(own) => Box::new(self.with_hardware(own)),
            Hardware::Serial(own) => Box::new(self.with_hardware(own)),
            Hardware::Raster(own) => Box::new(self.with_hardware(own)),
        }
    }
}
