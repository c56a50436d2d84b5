// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the playback of clips.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod clips;
mod monitor;
mod parallel;
mod player;
mod support;
