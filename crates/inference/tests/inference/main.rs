// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of a network behind a camera: the tables agree with each other, and no clip affects the
//! results of another.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod clips;
mod common;
mod sight;
mod tables;
