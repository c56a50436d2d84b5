// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of figures against ffmpeg, against a naive count of pixels, and by hand.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod by_hand;
mod ffmpeg;
mod likeness;
mod minima;
mod naive;
mod planted;
mod results;
mod staleness;
