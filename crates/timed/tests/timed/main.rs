// SPDX-License-Identifier: MIT OR Apache-2.0
//! The timed model against the cycle models: every transaction at every clock.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    reason = "small test numbers"
)]

#[path = "../../../engine/tests/engine/clip_script.rs"]
mod clip_script;
mod clips;
mod comparison;
mod driver;
mod event;
mod frame_beats;
mod frame_traffic;
mod memory;
mod observed_core;
mod page_examples;
#[allow(dead_code, reason = "the oracle of the model's tests uses the rest")]
#[path = "../../../model/tests/model/parameters.rs"]
mod parameters;
mod pipelined;
mod raster;
#[allow(dead_code, reason = "the oracle of the model's tests uses the rest")]
#[path = "../../../model/tests/model/raster/raster_parameters.rs"]
mod raster_parameters;
mod refusals;
mod serial;
#[allow(dead_code, reason = "the oracle of the model's tests uses the rest")]
#[path = "../../../model/tests/model/serial/serial_parameters.rs"]
mod serial_parameters;
mod timed_run;
mod traffic;
mod wrong_inputs;
