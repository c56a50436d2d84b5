// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the simulator: inputs of every kind, outputs compared with the model, and the state
//! that faults leave.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod batch;
mod clocks;
mod data_set;
mod decode;
mod explain;
mod inputs;
mod output_folder;
mod outputs;
mod packets;
mod periphery;
mod pictures;
mod pixel_events;
mod sets;
mod support;
mod tables;
mod video_faults;
mod wrong_numbers;
