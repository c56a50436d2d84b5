// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the simulator: inputs of every kind, outputs compared with the model, and the state
//! that faults leave.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod output_folder;
mod batch;
mod data_set;
mod decode;
mod explain;
mod wrong_numbers;
mod inputs;
mod outputs;
mod packets;
mod periphery;
mod pixel_events;
mod sets;
mod pictures;
mod support;
mod tables;
mod video_faults;
