// SPDX-License-Identifier: MIT OR Apache-2.0
//! When the value of an output is compared: some mean something only where a valid bit is 1.
//!
//! The valid bit is always that of the expected record, and valid bits themselves are compared at
//! every clock; so a valid bit that is wrong is found as such.

use crate::field::Field;

/// When a value is compared. Numbers are those of fields in the same layout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gate {
    /// At every clock.
    #[default]
    Always,
    /// Where this field is 1 in the same lane.
    SameLane(usize),
    /// Where this field is 1 in any lane.
    AnyLane(usize),
}

impl Gate {
    /// Whether no lane of a value is compared at this clock.
    pub(crate) fn is_shut(self, fields: &[Field], expected: &[u8]) -> bool {
        match self {
            Self::Always => false,
            Self::SameLane(valid) | Self::AnyLane(valid) => {
                fields[valid].slice(expected).iter().all(|&byte| byte == 0)
            }
        }
    }

    /// Whether a lane is compared at a clock at which the gate is not shut.
    pub(crate) fn lets_pass(self, fields: &[Field], expected: &[u8], lane: u32) -> bool {
        match self {
            Self::Always | Self::AnyLane(_) => true,
            Self::SameLane(valid) => fields[valid].get(expected, lane) == 1,
        }
    }
}
