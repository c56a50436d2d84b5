// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a design says of itself because of its organization: its unit, its timing, its ports.
//!
//! Nobody asks *which* organization a design has, but what follows from it. Every organization answers
//! all questions in a module of its own, as an implementation of [`Rules`]; [`Organization::rules`] is the
//! only place that lists them.

use crate::rules::{Rules, Unit};
use crate::{Design, Feed, HardwareConfig, MemoryKind, Organization, Port, Timing};
use crate::{pipelined::Pipelined, raster::Raster, serial::Serial};

impl Organization {
    /// The answers of the organization.
    pub(crate) fn rules(self) -> &'static dyn Rules {
        match self {
            Self::Pipelined => &Pipelined,
            Self::Serial => &Serial,
            Self::Raster => &Raster,
        }
    }

    /// What people call a unit of the array, such as "RPU".
    #[must_use]
    pub fn unit_name(self) -> &'static str {
        self.rules().unit_name()
    }

    /// The values that `hardware.feed` may have, the default first; none where it may not be given.
    #[must_use]
    pub fn feeds(self) -> &'static [Feed] {
        self.rules().feeds()
    }

    /// The values that `hardware.memory` may have; none where it may not be given.
    #[must_use]
    pub fn memories(self) -> &'static [MemoryKind] {
        self.rules().memories()
    }

    /// Whether regions may share a unit: `hardware.fold` may be more than 1.
    #[must_use]
    pub fn folds(self) -> bool {
        self.rules().folds()
    }
}

impl Design {
    /// What the array is made of.
    #[must_use]
    pub fn unit(&self) -> Unit {
        self.organization().rules().unit(self)
    }

    /// The design whose array module `rpu` is: this one where that is a part of the array, else the design
    /// of an array of one unit, whose frame may be wider than what a configuration may ask for.
    #[must_use]
    pub fn lone_unit(&self) -> Self {
        self.organization().rules().lone_unit(self)
    }

    /// When the design says what.
    #[must_use]
    pub fn timing(&self) -> Timing {
        self.organization().rules().timing(self)
    }

    /// The ports of module `rpu`, inputs first.
    #[must_use]
    pub fn rpu_ports(&self) -> Vec<Port> {
        self.organization().rules().rpu_ports(self)
    }

    /// The ports of module `rcm`, inputs first.
    #[must_use]
    pub fn rcm_ports(&self) -> Vec<Port> {
        self.organization().rules().rcm_ports(self)
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
        words.extend((self.sync == Some(true)).then(|| "frame sync".to_owned()));
        words.join(", ")
    }
}
