// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cameras that an organization can compute, and the unit, the timing and the ports of a
//! design.
//!
//! Each organization implements [`crate::rules::OrganizationRules`] in its own module, which
//! defines these properties.

use crate::pipelined::PipelinedHardware;
use crate::raster::RasterHardware;
use crate::rules::{ArrayUnit, OrganizationRules};
use crate::serial::SerialHardware;
use crate::takes::Taken;
use crate::{
    CoreInterface, Design, DesignTiming, Hardware, HardwareConfig, Organization, PixelFeed, Port,
};
use foveate_camera::{CameraConfig, FeatureKind, ReferencePolicy};

impl Organization {
    fn taken(self) -> Taken {
        match self {
            Self::Pipelined => Taken::by::<PipelinedHardware>(),
            Self::Serial => Taken::by::<SerialHardware>(),
            Self::Raster => Taken::by::<RasterHardware>(),
        }
    }

    /// Returns true if the organization computes the score of the feature.
    #[must_use]
    pub fn takes_feature(self, kind: FeatureKind) -> bool {
        (self.taken().feature)(kind)
    }

    /// Returns true if the organization can store the reference.
    #[must_use]
    pub fn takes_reference(self, reference: ReferencePolicy) -> bool {
        (self.taken().reference)(reference)
    }

    /// Returns true if the organization supports the features of a camera, its reference and the
    /// rendering of its irrelevant regions. Sizes and keys of `[hardware]` may still be refused by
    /// [`crate::DesignConfig::validate`].
    #[must_use]
    pub fn takes(self, camera: &CameraConfig) -> bool {
        self.taken().takes(camera)
    }

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

/// Returns true if some organization supports the camera. A search over features, references or
/// renderings calls this function, so that it does not choose a camera that no organization can
/// compute.
#[must_use]
pub fn is_taken(camera: &CameraConfig) -> bool {
    Organization::ALL.iter().any(|organization| organization.takes(camera))
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
