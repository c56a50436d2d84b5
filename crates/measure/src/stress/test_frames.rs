// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames for single cases, and random numbers that are the same on every machine.

use foveate_pixels::Frame;

/// Makes a frame from a function of column and row.
pub(crate) fn frame_from_fn(size: (u32, u32), bits: u32, pixel: impl Fn(u32, u32) -> u32) -> Frame {
    let pixel = |x, y| u16::try_from(pixel(x, y)).expect("a pixel has at most 16 bits");
    Frame::from_fn(size.0, size.1, bits, pixel)
        .unwrap_or_else(|error| unreachable!("a case makes valid frames: {error}"))
}

/// A small generator of random numbers, an LCG whose upper bits are mixed.
#[derive(Clone, Debug)]
pub(crate) struct RandomNumbers(u64);

impl RandomNumbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed ^ 0x9E37_79B9_7F4A_7C15)
    }

    /// Returns a number in 0..bound.
    pub(crate) fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        let mixed = (self.0 ^ (self.0 >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        (mixed ^ (mixed >> 32)) % bound.max(1)
    }

    /// Returns a frame of random pixels.
    pub(crate) fn frame(&mut self, size: (u32, u32), bits: u32) -> Frame {
        let (width, height) = (size.0 as usize, size.1 as usize);
        let pixels = (0..width * height)
            .map(|_| u16::try_from(self.below(1 << bits)).expect("a pixel has at most 16 bits"))
            .collect();
        Frame::new(size.0, size.1, bits, pixels)
            .unwrap_or_else(|error| unreachable!("random frames are valid: {error}"))
    }
}
