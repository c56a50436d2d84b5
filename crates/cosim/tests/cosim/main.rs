// SPDX-License-Identifier: MIT OR Apache-2.0
//! Co-simulation tests: model against emitted RTL and netlists, planted faults, vectors, and
//! machinery.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod bus;
mod cells;
mod common;
mod diagram;
mod driver;
mod equal_results;
mod folders;
mod harness;
mod large;
mod mutated_modules;
mod negative_control;
mod netlist;
mod pipelined_matrix;
mod port_widths;
mod preset_agreement;
mod raster_ends;
mod raster_stimulus;
mod raster_stores;
mod raster_summaries;
mod report;
mod serial_matrix;
mod serial_stimulus;
mod shipped;
mod shipped_faults;
mod situations;
mod stimulus;
mod sync;
mod valid_gates;
mod zones;
