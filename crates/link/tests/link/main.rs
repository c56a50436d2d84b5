// SPDX-License-Identifier: MIT OR Apache-2.0
//! The link against a simulation bit by bit, cameras against times by hand, and codecs against ffprobe.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod codecs;
mod queue;
mod senders;
