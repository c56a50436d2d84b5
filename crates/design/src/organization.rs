// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a design says of itself because of its organization: its unit, its timing, its ports.
//!
//! Nobody asks *which* organization a design has, but what follows from it. Every organization answers
//! all questions in a module of its own, as an implementation of [`Rules`]; [`Organization::rules`] is the
//! only place that lists them.

use crate::{Design, DesignError, Feed, HardwareConfig, MemoryKind, Organization, Port, Timing};
use crate::{pipelined::Pipelined, serial::Serial};

/// What an array is made of, as often as it needs: an RPU, a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// What people call one.
    pub name: &'static str,
    /// Its Verilog module.
    pub module: &'static str,
    /// How many the array has.
    pub count: u32,
    /// Regions that one serves, the last perhaps fewer.
    pub regions: u32,
    /// Whether the array `rcm` instantiates the module `rpu`. If not, `rpu` is an array of its own, with
    /// one unit.
    pub rpu_in_rcm: bool,
    /// The Verilog module whose instances say where the area goes.
    pub split: &'static str,
}

/// What an organization answers.
pub(crate) trait Rules {
    /// The unit of a design.
    fn unit(&self, design: &Design) -> Unit;
    /// What people call a unit.
    fn unit_name(&self) -> &'static str;
    /// How pixels may enter, the default first; none where there is no choice.
    fn feeds(&self) -> &'static [Feed];
    /// Of what the memory of a unit may be built, `hardware.memory`; none where there is no choice.
    fn memories(&self) -> &'static [MemoryKind];
    /// Whether regions may share a unit, `hardware.fold`.
    fn folds(&self) -> bool;
    /// `[hardware]` for a frame of so many `regions` of `size` x `size` pixels, its keys filled in.
    fn hardware(
        &self,
        asked: &HardwareConfig,
        size: u32,
        regions: u32,
    ) -> Result<HardwareConfig, DesignError>;
    /// The design whose ports module `rpu` has.
    fn lone_unit(&self, design: &Design) -> Design;
    /// When a design says what.
    fn timing(&self, design: &Design) -> Timing;
    /// The ports of module `rpu`, inputs first.
    fn rpu_ports(&self, design: &Design) -> Vec<Port>;
    /// The ports of module `rcm`, inputs first.
    fn rcm_ports(&self, design: &Design) -> Vec<Port>;
}

impl Organization {
    /// The answers of the organization.
    pub(crate) fn rules(self) -> &'static dyn Rules {
        match self {
            Self::Pipelined => &Pipelined,
            Self::Serial => &Serial,
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
        words.join(", ")
    }
}
