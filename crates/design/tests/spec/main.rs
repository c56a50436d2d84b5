// SPDX-License-Identifier: MIT OR Apache-2.0
//! The configuration at its boundary.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod configuration;
mod depth;
mod fuzz;
mod interface;
mod sync;
