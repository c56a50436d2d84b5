// SPDX-License-Identifier: MIT OR Apache-2.0
//! The engine against the functional model: every camera, all options, many frames.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod batches;
mod clip_script;
mod hard_cases;
mod losses;
mod memory;
mod properties;
mod random_cameras;
mod refusals;
mod zones;
