// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inputs that only a core with zones has, clock by clock: classes of regions, and thresholds of
//! regions that are keen or off.

use super::random::Random;
use foveate_design::{Design, RegionClass};
use foveate_model::{ThresholdInputs, ZoneInputs};

/// One in this many lanes gets another class when the map changes.
const LANES_PER_CHANGE: usize = 16;

/// The classes of the regions in a sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ClassChoice {
    /// All regions are normal.
    Normal,
    /// Classes change at random, also while frames are under way.
    Changing,
    /// The classes of the configuration. A lone unit is normal.
    Configured,
}

/// The inputs of zones.
#[derive(Clone, Debug)]
pub(super) struct PortZones {
    configured: Vec<RegionClass>,
    classes: Vec<RegionClass>,
    pub(super) keen: ThresholdInputs,
    pub(super) off_summary_level: u32,
    /// True if the map changes, also while frames are under way.
    changes: bool,
}

impl PortZones {
    /// Returns the inputs of a design with `lanes` regions at its ports, or `None` if it has no
    /// zones.
    pub(super) fn of_design(design: &Design, lanes: usize) -> Option<Self> {
        let configured = design.zones()?.configured_classes();
        let normal = vec![RegionClass::Normal; lanes];
        Some(Self {
            configured: if configured.len() == lanes { configured.to_vec() } else { normal },
            classes: vec![RegionClass::Normal; lanes],
            keen: ThresholdInputs::of_class(design, RegionClass::Keen),
            off_summary_level: ThresholdInputs::of_class(design, RegionClass::Off).summary_level,
            changes: false,
        })
    }

    /// Begins a sequence with these classes.
    pub(super) fn begin_sequence(&mut self, choice: ClassChoice) {
        self.changes = choice == ClassChoice::Changing;
        match choice {
            ClassChoice::Configured => self.classes.copy_from_slice(&self.configured),
            ClassChoice::Normal | ClassChoice::Changing => self.classes.fill(RegionClass::Normal),
        }
    }

    /// Begins a clock. The hardware takes a class only at the first step of a frame, so the map may
    /// change at any clock.
    pub(super) fn begin_clock(&mut self, random: &mut Random) {
        if !self.changes || !random.one_in(3) {
            return;
        }
        for _ in 0..self.classes.len().div_ceil(LANES_PER_CHANGE) {
            let lane = random.index(self.classes.len() - 1);
            self.classes[lane] = RegionClass::ALL[random.index(RegionClass::ALL.len() - 1)];
        }
    }

    /// Returns the values of the inputs.
    pub(super) fn inputs(&self) -> ZoneInputs<'_> {
        ZoneInputs {
            classes: &self.classes,
            keen: &self.keen,
            off_summary_level: self.off_summary_level,
        }
    }
}
