// SPDX-License-Identifier: MIT OR Apache-2.0
//! Boxes of files, and the regions that belong to them.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod assigned;
mod formats;
mod mistakes;
mod properties;
mod support;
