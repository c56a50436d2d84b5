// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs of a network behind a camera: what the tables say agrees among them, and every clip stands alone.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod clips;
mod common;
mod sight;
mod tables;
