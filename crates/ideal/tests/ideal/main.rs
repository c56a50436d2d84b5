// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the ideal camera, by hand and against the functional model.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod by_hand;
mod generators;
#[path = "../../../engine/tests/engine/largest_thresholds.rs"]
mod largest_thresholds;
mod model;
