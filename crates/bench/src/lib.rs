// SPDX-License-Identifier: MIT OR Apache-2.0
//! Benchmarks: the same frames run through every level of a design. The result is the cost of each
//! level, and whether the levels agree.
//!
//! A [`Benchmark`] goes from whole frames down to gates. Each level runs on one thread, one after
//! the other, and is compared with a level above it:
//!
//! ```text
//! functional, clear   FunctionalCamera  frames          the reference
//! functional, fast    Engine            frames          every result of every region =
//! FunctionalCamera cycle               PipelinedRcm, ..  clocks          every score and decision
//! = FunctionalCamera RTL                 Verilator         clocks          every port at every
//! clock = cycle netlist             Icarus            one RPU         every port at every clock =
//! cycle
//! ```
//!
//! The levels with clocks take the same [`Recording`](foveate_cosim::Recording). Each level is
//! first compared, in a separate pass, and then timed from memory, without files, comparison or
//! reading of outputs.

mod benchmark;
mod clock_rates;
mod cycle_level;
mod error;
mod frames;
mod functional_levels;
#[cfg(test)]
mod negative_control;
mod netlist_level;
mod outcome_comparison;
mod peak_memory;
mod report;
mod rtl_level;
mod timer;
mod tools;
mod vectors;

pub use benchmark::Benchmark;
pub use error::BenchmarkError;
pub use frames::random_frames;
pub use report::{BenchmarkLevel, BenchmarkReport, FORMAT_VERSION, LevelMeasurement, LevelRow};
pub use tools::ExternalTools;
