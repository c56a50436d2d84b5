// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of external tools: real ones, and programs that misbehave.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod tools;
mod unusable;
