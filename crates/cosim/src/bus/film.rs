// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames for the buses: something moves before something still, and now and then all regions are active.

use crate::stimulus::Random;
use foveate_design::RasterDesign;
use foveate_frame::Frame;

/// Pixels of a side of what moves, at most.
const MOVING: u32 = 16;
/// Pixels of a side of what stands still and is of one grey level. A region in an odd column is a single tile, and irrelevant.
const TILE: u32 = 4;
/// One of so many tiles gets another grey level with each frame, by this at most: means differ by more than a level, and by less.
const DRIFTS: u64 = 8;
const DRIFT: u16 = 24;
/// One of so many frames is nothing but noise.
const NOISE: u32 = 3;

/// Frames of a design, one after the other.
pub(super) struct Film {
    /// Grey levels of the tiles that stand still, row by row.
    tiles: Vec<u16>,
    size: (u32, u32),
    side: u32,
    bits: u32,
    number: u32,
    flicker: u16,
    random: Random,
}

impl Film {
    pub(super) fn new(design: RasterDesign<'_>, random: &mut Random) -> Self {
        let (size, bits, mut random) =
            ((design.width(), design.height()), design.pixel_bits(), random.fork());
        let tiles = (0..size.0.div_ceil(TILE) * size.1.div_ceil(TILE))
            .map(|_| random.pixel(largest(bits) / 2))
            .collect();
        // No change, but with half the level it would be one.
        let flicker =
            u16::try_from(design.temporal().level).unwrap_or(u16::MAX).min(largest(bits) / 2);
        Self { tiles, size, side: design.region_size(), bits, number: 0, flicker, random }
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

    /// The next frame, which flickers as far as it can without the highest bit.
    pub(super) fn flickering(&mut self) -> Frame {
        let flicker = std::mem::replace(&mut self.flicker, largest(self.bits) / 2);
        let frame = self.quiet();
        self.flicker = flicker;
        frame
    }

    fn drift(&mut self) {
        let most = largest(self.bits);
        for tile in &mut self.tiles {
            if self.random.one_in(DRIFTS) {
                let (up, by) = (self.random.one_in(2), self.random.pixel(DRIFT.min(most / 4)));
                *tile = match up {
                    true => tile.saturating_add(by).min(most / 2),
                    false => tile.saturating_sub(by),
                };
            }
        }
    }

    /// What stands still at a place.
    fn still(&self, x: u32, y: u32) -> u16 {
        let start = |at: u32| at / self.side * self.side;
        let is_plain = x / self.side % 2 == 1;
        let (x, y) = if is_plain { (start(x), start(y)) } else { (x, y) };
        self.tiles[(y / TILE * self.size.0.div_ceil(TILE) + x / TILE) as usize]
    }

    fn shot(&mut self, is_noise: bool) -> Frame {
        let (width, height) = self.size;
        let (across, down) = (MOVING.min(width), MOVING.min(height));
        let from = (self.number * 5 % (width - across + 1), self.number * 3 % (height - down + 1));
        self.number += 1;
        self.drift();
        let mut pixels = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let inside = x.wrapping_sub(from.0) < across && y.wrapping_sub(from.1) < down;
                pixels.push(match inside || is_noise {
                    true => self.random.pixel(largest(self.bits)),
                    false => self.still(x, y).saturating_add(self.random.pixel(self.flicker)),
                });
            }
        }
        Frame::new(width, height, self.bits, pixels).expect("pixels are at most the largest")
    }
}

/// The largest pixel of so many bits.
pub(super) fn largest(bits: u32) -> u16 {
    u16::try_from((1_u32 << bits) - 1).expect("a pixel has at most 16 bits")
}
