// SPDX-License-Identifier: MIT OR Apache-2.0
//! Co-simulation tests: model against emitted RTL and netlists, planted faults, vectors, and
//! machinery.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod bus;
mod cells;
mod common;
mod preset_agreement;
mod diagram;
mod driver;
mod folders;
mod valid_gates;
mod large;
mod harness;
mod pipelined_matrix;
mod negative_control;
mod netlist;
mod raster_ends;
mod raster_stimulus;
mod raster_stores;
mod raster_summaries;
mod report;
mod equal_results;
mod serial_matrix;
mod serial_stimulus;
mod shipped;
mod shipped_faults;
mod situations;
mod stimulus;
mod sync;
mod port_widths;
