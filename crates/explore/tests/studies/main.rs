// SPDX-License-Identifier: MIT OR Apache-2.0
//! Studies over scenes with known results.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod inputs;
mod recall;
mod studies;
mod support;
