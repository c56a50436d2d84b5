// SPDX-License-Identifier: MIT OR Apache-2.0
//! The properties that every organization defines for its designs. The methods of `Design` in
//! [`crate::organization`] return them.

use crate::{CoreInterface, Design, DesignTiming};

/// The structure of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArrayStructure {
    /// The array consists of copies of module `rpu` and nothing else. The size of the array is only
    /// the number of copies, and no copy depends on it.
    RpuCopies,
    /// The array has units that share logic, or is one core. Widths, memories and counters depend
    /// on its size. Module `rpu` is not a part of it, but an array of its own with one unit.
    SharedLogic,
}

/// The unit that an array repeats: an RPU, a lane, or the one core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArrayUnit {
    /// Name of one unit for users.
    pub name: &'static str,
    /// Verilog module of the unit.
    pub module: &'static str,
    /// Number of units of the array.
    pub count: u32,
    /// Number of regions that one unit serves. The last unit may serve fewer.
    pub regions: u32,
    /// Structure of the array.
    pub array: ArrayStructure,
    /// Verilog module whose instances the area is reported for.
    pub area_module: &'static str,
}

/// The properties of a [`crate::DesignWithHardware`] the hardware of one organization.
pub(crate) trait OrganizationRules {
    /// Returns the unit that the array repeats.
    fn unit(&self) -> ArrayUnit;
    /// Returns the design that module `rpu` belongs to.
    fn lone_unit(&self) -> Design;
    /// Returns the timing of the design.
    fn timing(&self) -> DesignTiming;
    /// Returns the interface of module `rpu`. Where the RPU is not a part of the array, it is that
    /// of an array with one unit.
    fn rpu_interface(&self) -> CoreInterface {
        self.lone_unit().rcm_interface()
    }
    /// Returns the interface of module `rcm`.
    fn rcm_interface(&self) -> CoreInterface;
}
