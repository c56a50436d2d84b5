// SPDX-License-Identifier: MIT OR Apache-2.0
//! The class of a region in a camera with zones, and maps, which have a class for every region.

use crate::choice;
use thiserror::Error;

choice! {
    /// The class of a region: its thresholds, and whether its SRS follows from its votes.
    #[derive(Default)]
    RegionClass {
        /// SRS follows from the votes with the thresholds of the camera.
        #[default]
        Normal = "normal",
        /// SRS is 0. Summaries have a level of their own.
        Off = "off",
        /// SRS follows from the votes with the keen thresholds.
        Keen = "keen",
        /// SRS is 1.
        Always = "always",
    }
}

impl RegionClass {
    /// Returns the number of the class in maps, ports and memories, 0..=3.
    #[must_use]
    pub fn code(self) -> u8 {
        match self {
            Self::Normal => 0,
            Self::Off => 1,
            Self::Keen => 2,
            Self::Always => 3,
        }
    }

    /// Returns the number of the class as a digit, as `zones.classes` has it.
    #[must_use]
    pub fn digit(self) -> char {
        char::from(b'0' + self.code())
    }

    /// Returns the class with this number, or `None` if there is none.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.iter().copied().find(|class| class.code() == code)
    }

    /// Returns the SRS of the regions of the class, or `None` if it follows from the votes.
    #[must_use]
    pub fn forced_srs(self) -> Option<bool> {
        match self {
            Self::Normal | Self::Keen => None,
            Self::Off => Some(false),
            Self::Always => Some(true),
        }
    }
}

/// An error of a map that does not fit the camera.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum ClassMapError {
    /// A map that does not have one class per region.
    #[error(
        "the map has {given} classes, but the camera has {regions} regions; give it one class per \
         region"
    )]
    Count { given: usize, regions: u32 },
    /// A class other than `normal` in a camera without zones.
    #[error(
        "region {region} has the class `{class}`, but the camera has no zones; use the class \
         `normal`, or a camera with zones"
    )]
    NoZones { region: usize, class: RegionClass },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_those_of_the_contract() {
        let codes = RegionClass::ALL.iter().map(|class| class.code());
        assert_eq!(codes.collect::<Vec<_>>(), [0, 1, 2, 3]);
        for code in 0..=u8::MAX {
            assert_eq!(
                RegionClass::from_code(code).map(RegionClass::code),
                (code < 4).then_some(code)
            );
        }
    }
}
