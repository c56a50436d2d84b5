// SPDX-License-Identifier: MIT OR Apache-2.0
//! The condition under which the value of an output is compared. Some outputs are valid only while
//! a valid bit is 1.
//!
//! The valid bit is always that of the expected record. Valid bits themselves are compared at every
//! clock, so a wrong valid bit is found as such.

/// The condition under which a value is compared. The numbers are indices of fields in the same
/// layout.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ComparisonGate {
    /// The value is compared at every clock.
    #[default]
    Always,
    /// The value is compared if this field is 1 in the same lane.
    SameLane(usize),
    /// The value is compared if this field is 1 in any lane.
    AnyLane(usize),
}
