// SPDX-License-Identifier: MIT OR Apache-2.0
//! Footage: images, video and their times against what the formats say.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod clips;
mod damage;
mod formats;
mod fuzz;
mod memory;
mod pictures;
mod seek;
mod sets;
mod video;
mod waiting;
