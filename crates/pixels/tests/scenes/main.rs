// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of scenes: the cases that they show, and their bytes.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod cases;
mod scenes;
