// SPDX-License-Identifier: MIT OR Apache-2.0
//! When the value of an output is compared: some outputs are valid only where a valid bit is 1.
//!
//! The valid bit is always that of the expected record, and valid bits themselves are compared at
//! every clock; so a valid bit that is wrong is found as such.

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
