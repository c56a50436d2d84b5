// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames for the buses: something moves before something still, and now and then all regions are active.

use crate::stimulus::Random;
use foveate_design::RasterDesign;
use foveate_frame::Frame;

/// Pixels of a side of what moves, at most.
const MOVING: u32 = 16;
/// Pixels of a side of what stands still and is of one grey level.
const TILE: u32 = 4;
/// One of so many frames is nothing but noise.
const NOISE: u32 = 3;

/// Frames of a design, one after the other.
pub(super) struct Film {
    still: Vec<u16>,
    size: (u32, u32),
    bits: u32,
    number: u32,
    flicker: u16,
    random: Random,
}

impl Film {
    pub(super) fn new(design: RasterDesign<'_>, random: &mut Random) -> Self {
        let (size, bits, mut random) =
            ((design.width(), design.height()), design.pixel_bits(), random.fork());
        let tiles_across = size.0.div_ceil(TILE);
        let tiles: Vec<u16> = (0..tiles_across * size.1.div_ceil(TILE))
            .map(|_| random.pixel(largest(bits) / 2))
            .collect();
        let tile = |x: u32, y: u32| tiles[(y / TILE * tiles_across + x / TILE) as usize];
        let still =
            (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y))).map(|(x, y)| tile(x, y));
        // No change, but with half the level it would be one.
        let flicker =
            u16::try_from(design.temporal().level).unwrap_or(u16::MAX).min(largest(bits) / 2);
        Self { still: still.collect(), size, bits, number: 0, flicker, random }
    }

    /// The next frame.
    pub(super) fn next(&mut self) -> Frame {
        self.shot(self.number % NOISE == NOISE - 1)
    }

    /// The next frame, which is nothing but noise.
    pub(super) fn noise(&mut self) -> Frame {
        self.shot(true)
    }

    /// The next frame, with something that moves before something that flickers.
    pub(super) fn quiet(&mut self) -> Frame {
        self.shot(false)
    }

    fn shot(&mut self, is_noise: bool) -> Frame {
        let (width, height) = self.size;
        let (across, down) = (MOVING.min(width), MOVING.min(height));
        let from = (self.number * 5 % (width - across + 1), self.number * 3 % (height - down + 1));
        self.number += 1;
        let mut pixels = self.still.clone();
        for y in 0..height {
            for x in 0..width {
                let inside = x.wrapping_sub(from.0) < across && y.wrapping_sub(from.1) < down;
                let pixel = &mut pixels[(y * width + x) as usize];
                *pixel = match inside || is_noise {
                    true => self.random.pixel(largest(self.bits)),
                    false => (*pixel).saturating_add(self.random.pixel(self.flicker)),
                };
            }
        }
        Frame::new(width, height, self.bits, pixels).expect("pixels are at most the largest")
    }
}

/// The largest pixel of so many bits.
pub(super) fn largest(bits: u32) -> u16 {
    u16::try_from((1_u32 << bits) - 1).expect("a pixel has at most 16 bits")
}
