// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an organization takes, and what a design says of itself because of its organization: its unit, its timing,
//! its ports.
//!
//! Each organization answers in a module of its own, as an implementation of [`crate::rules::Rules`].

use crate::pipelined::Pipelined;
use crate::raster::Raster;
use crate::rules::{Rules, Unit};
use crate::serial::Serial;
use crate::takes::Taken;
use crate::{Design, Feed, Hardware, HardwareConfig, Interface, Organization, Port, Timing};
use foveate_camera::{CameraConfig, FeatureKind, Reference};

impl Organization {
    fn taken(self) -> Taken {
        match self {
            Self::Pipelined => Taken::by::<Pipelined>(),
            Self::Serial => Taken::by::<Serial>(),
            Self::Raster => Taken::by::<Raster>(),
        }
    }

    /// Whether it computes the score of a feature.
    #[must_use]
    pub fn takes_feature(self, kind: FeatureKind) -> bool {
        (self.taken().feature)(kind)
    }

    /// Whether it keeps such a reference.
    #[must_use]
    pub fn takes_reference(self, reference: Reference) -> bool {
        (self.taken().reference)(reference)
    }

    /// Whether it takes the features of a camera, its reference and what its irrelevant regions show. Sizes and keys of
    /// `[hardware]` may still not go together: [`crate::Config::validate`] says so.
    #[must_use]
    pub fn takes(self, camera: &CameraConfig) -> bool {
        self.taken().takes(camera)
    }

    /// What people call a unit of the array, such as "RPU".
    #[must_use]
    pub fn unit_name(self) -> &'static str {
        match self {
            Self::Pipelined => "RPU",
            Self::Serial => "lane",
            Self::Raster => "core",
        }
    }

    /// The values that `hardware.feed` may have, the default first; none where it may not be given.
    #[must_use]
    pub fn feeds(self) -> &'static [Feed] {
        match self {
            Self::Serial => Feed::ALL,
            Self::Pipelined | Self::Raster => &[],
        }
    }

    /// Whether regions may share a unit: `hardware.fold` may be more than 1.
    #[must_use]
    pub fn folds(self) -> bool {
        match self {
            Self::Serial => true,
            Self::Pipelined | Self::Raster => false,
        }
    }
}

/// Whether some organization takes a camera. What tries features, references or ways to show irrelevant regions asks this,
/// so that it does not choose what nobody can build.
#[must_use]
pub fn is_taken(camera: &CameraConfig) -> bool {
    Organization::ALL.iter().any(|organization| organization.takes(camera))
}

impl Design {
    /// The unit that the array repeats, and what the array is made of.
    #[must_use]
    pub fn unit(&self) -> Unit {
        self.rules().unit()
    }

    /// The design whose array module `rpu` is: this one where that is a part of the array, else the design
    /// of an array of one unit, whose frame may be wider than what a configuration may ask for.
    #[must_use]
    pub fn lone_unit(&self) -> Self {
        self.rules().lone_unit()
    }

    /// When the design says what.
    #[must_use]
    pub fn timing(&self) -> Timing {
        self.rules().timing()
    }

    /// The interface of module `rpu`.
    #[must_use]
    pub fn rpu_interface(&self) -> Interface {
        self.rules().rpu_interface()
    }

    /// The interface of module `rcm`.
    #[must_use]
    pub fn rcm_interface(&self) -> Interface {
        self.rules().rcm_interface()
    }

    /// The ports of module `rpu`, inputs first.
    #[must_use]
    pub fn rpu_ports(&self) -> Vec<Port> {
        self.rpu_interface().ports()
    }

    /// The ports of module `rcm`, inputs first.
    #[must_use]
    pub fn rcm_ports(&self) -> Vec<Port> {
        self.rcm_interface().ports()
    }

    /// What every organization answers.
    fn rules(&self) -> Box<dyn Rules + '_> {
        match self.hardware() {
            Hardware::Pipelined(own) => Box::new(self.on(own)),
            Hardware::Serial(own) => Box::new(self.on(own)),
            Hardware::Raster(own) => Box::new(self.on(own)),
        }
    }
}

impl HardwareConfig {
    /// The organization in a few words, such as "serial, raster feed, fold 4".
    #[must_use]
    pub fn in_words(&self) -> String {
        let mut words = vec![self.organization.name().to_owned()];
        let default = self.organization.feeds().first().copied();
        words.extend(self.feed.or(default).map(|feed| format!("{feed} feed")));
        words.extend(self.organization.folds().then(|| format!("fold {}", self.fold)));
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
