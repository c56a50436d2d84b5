// SPDX-License-Identifier: MIT OR Apache-2.0
//! The unit, the timing and the ports of a design.
//!
//! Each organization implements [`crate::rules::OrganizationRules`] in its own module, which
//! defines these properties.

use crate::rules::{ArrayUnit, OrganizationRules};
use crate::{
    CoreInterface, Design, DesignTiming, Hardware, HardwareConfig, Organization, PixelFeed, Port,
};

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

    /// Returns the values that `hardware.feed` may have, the default first. The list is empty if
    /// the key is refused.
    #[must_use]
    pub fn feeds(self) -> &'static [PixelFeed] {
        match self {
            Self::Serial => PixelFeed::ALL,
            Self::Pipelined | Self::Raster => &[],
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

impl HardwareConfig {
    /// Returns a short description of the hardware, such as "serial, raster feed, fold 4".
    #[must_use]
    pub fn description(&self) -> String {
        let mut words = vec![self.organization.name().to_owned()];
        let default = self.organization.feeds().first().copied();
        words.extend(self.feed.or(default).map(|feed| format!("{feed} feed")));
        words.extend(self.organization.has_folding().then(|| format!("fold {}", self.fold)));
        words.extend(self.memory.map(|memory| format!("{memory} memory")));
        words.extend(self.pixels_per_clock.map(|pixels| {
            let plural = if pixels == 1 { "" } else { "s" };
            format!("{pixels} pixel{plural} per clock")
        }));
        words.extend(self.pipelining.map(|pipelining| format!("{pipelining} pipelining")));
        words.extend(self.store.map(|store| format!("{store} store")));
        words.extend((self.forward == Some(false)).then(|| "no forwarding".to_owned()));
        words.extend(self.interface.map(|bus| format!("interface {bus}")));
        words.extend((self.sync == Some(true)).then(|| "frame sync".to_owned()));
        words.join(", ")
    }
}
