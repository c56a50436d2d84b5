// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of box files, and of the regions that belong to a box.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod assignment;
mod formats;
mod mistakes;
mod properties;
mod support;
