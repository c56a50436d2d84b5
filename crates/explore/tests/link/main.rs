// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the link against a simulation bit by bit, of cameras and clips against times by hand,
//! and of codecs against ffprobe.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod clip_load;
mod codecs;
mod queue;
mod raster;
mod senders;
