// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the link against a simulation bit by bit, of cameras against times by hand, and of
//! codecs against ffprobe.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod codecs;
mod queue;
mod raster;
mod senders;
