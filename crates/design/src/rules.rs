// SPDX-License-Identifier: MIT OR Apache-2.0
//! The questions that every organization answers of its designs; [`crate::organization`] asks them.

use crate::{Design, Interface, Timing};

/// What an array is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Array {
    /// Copies of module `rpu` and nothing else: its size says only how many there are, and none of them knows of it.
    Copies,
    /// Units that share what is there once, or one core: widths, memories and counters follow from its size. Module
    /// `rpu` is no part of it, but an array of its own, with one unit.
    Whole,
}

/// The unit that an array repeats: an RPU, a lane; or the one core.
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
    /// What the array is made of.
    pub array: Array,
    /// The Verilog module whose instances say where the area goes.
    pub split: &'static str,
}

/// What a [`crate::DesignOn`] some hardware answers.
pub(crate) trait Rules {
    /// The unit that the array repeats.
    fn unit(&self) -> Unit;
    /// The design whose ports module `rpu` has.
    fn lone_unit(&self) -> Design;
    /// When it says what.
    fn timing(&self) -> Timing;
    /// The interface of module `rpu`: where it is no part of the array, that of an array of one unit.
    fn rpu_interface(&self) -> Interface {
        self.lone_unit().rcm_interface()
    }
    /// The interface of module `rcm`.
    fn rcm_interface(&self) -> Interface;
}
