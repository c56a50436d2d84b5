// SPDX-License-Identifier: MIT OR Apache-2.0
//! External tools, real ones and such as misbehave.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod tools;
mod unusable;
