// SPDX-License-Identifier: MIT OR Apache-2.0
//! Benchmarks: the same frames run through every level of a design. The result is the cost of each
//! level, and whether the levels agree.
//!
//! A [`Bench`] goes from whole frames down to gates. Each level runs on one thread, one after the
//! other, and is compared with a level above it:
//!
//! ```text
//! functional, clear   FunctionalCamera  frames          the reference
//! functional, fast    Engine            frames          every result of every region = FunctionalCamera
//! cycle               PipelinedRcm, ..  clocks          every score and decision = FunctionalCamera
//! RTL                 Verilator         clocks          every port at every clock = cycle
//! netlist             Icarus            one RPU         every port at every clock = cycle
//! ```
//!
//! The levels with clocks take the same [`Recording`](foveate_cosim::Recording). Each level is
//! first compared, in a separate pass, and then timed from memory, without files, comparison or
//! reading of outputs.

mod bench;
mod cycle;
mod error;
#[cfg(test)]
mod falsified;
mod frames;
mod functional;
mod memory;
mod netlist;
mod outcomes;
mod rate;
mod report;
mod rtl;
mod timer;
mod tools;
mod vectors;

pub use bench::Bench;
pub use error::BenchError;
pub use frames::random_frames;
pub use report::{BenchReport, FORMAT_VERSION, Level, LevelRow, Measured};
pub use tools::Tools;
