// SPDX-License-Identifier: MIT OR Apache-2.0
//! The energy of a design in the cells of a process, from the activity of a clip.
//!
//! Yosys maps one unit of the design, an RPU or a lane, to cells. The unit takes regions of the
//! frames of a clip without a pause: a simulation of gates computes its nets, 64 regions at a time,
//! compares its outputs with those of the model, and counts the rises and falls of every net. The
//! energy follows from these counts and the tables of the library, without OpenSTA: the version of
//! 2019 takes the energies of a rise and of a fall for each change, and knows no activity of single
//! nets.

mod activity;
mod energy_job;
mod energy_sum;
mod error;
mod gate_simulation;
mod report;
mod simulated_netlist;
mod stretches;
#[cfg(test)]
mod testing;
mod unit_activity;

pub use energy_job::{EnergyJob, measure_energy};
pub use error::EnergyError;
pub use report::{ENERGY_FORMAT_VERSION, EnergyReport, PartEnergies, StretchEnergy};
pub use stretches::ActivityClip;
