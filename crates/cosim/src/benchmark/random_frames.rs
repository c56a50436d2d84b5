// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames of random pixels, on which no level can skip work.

use foveate_design::Design;
use foveate_pixels::{Frame, FrameError};

/// Returns `count` frames with the size and depth of the design and random pixels. Equal seeds give
/// equal frames.
///
/// # Errors
/// A valid design causes no error.
pub fn random_frames(design: &Design, seed: u64, count: u32) -> Result<Vec<Frame>, FrameError> {
    let mut state = seed ^ 0x9E37_79B9_7F4A_7C15;
    let mut pixel = |_, _| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        let mixed = (state ^ (state >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let value = (mixed ^ (mixed >> 32)) & u64::from(design.pixel_max());
        u16::try_from(value).expect("masked to the pixel's bits")
    };
    let (width, height, bits) = (design.width(), design.height(), design.pixel_bits());
    (0..count).map(|_| Frame::from_fn(width, height, bits, &mut pixel)).collect()
}
