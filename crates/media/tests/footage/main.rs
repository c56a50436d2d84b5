// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of footage: images, video and their times against the definitions of the formats.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod clips;
mod damaged_images;
mod formats;
mod fuzz;
mod luma;
mod memory;
mod mosaics;
mod orientation;
mod pictures;
mod raw;
mod seek;
mod sequences;
mod sets;
mod streams;
mod timestamps;
mod video;
mod waits;
mod zip_archives;
