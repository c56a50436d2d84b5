// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames for the buses: a square of noise moves over a still background, and every third frame is
//! noise, so that all regions are active.

use crate::stimulus::Random;
use foveate_design::RasterDesign;
use foveate_frame::Frame;

/// The largest side of the moving square, in pixels.
const MOVING_SIDE: u32 = 16;
/// The side of a background tile of one gray level, in pixels. A region in an odd column shows a
/// single tile, and is irrelevant.
const TILE_SIDE: u32 = 4;
/// One in `DRIFT_PERIOD` tiles changes its gray level with each frame, by `MAX_DRIFT` at most. So
/// some means differ by more than the summary level, and some by less.
const DRIFT_PERIOD: u64 = 8;
const MAX_DRIFT: u16 = 24;
/// One in `NOISE_PERIOD` frames is noise all over.
const NOISE_PERIOD: u32 = 3;

/// A source of frames for a design, one after the other.
pub(super) struct BusFrameSource {
    /// The gray levels of the background tiles, row by row.
    tiles: Vec<u16>,
    size: (u32, u32),
    side: u32,
    bits: u32,
    frame_number: u32,
    flicker: u16,
    random: Random,
}

impl BusFrameSource {
    pub(super) fn new(design: RasterDesign<'_>, random: &mut Random) -> Self {
        let (size, bits, mut random) =
            ((design.width(), design.height()), design.pixel_bits(), random.fork());
        let tiles = (0..size.0.div_ceil(TILE_SIDE) * size.1.div_ceil(TILE_SIDE))
            .map(|_| random.pixel(largest_pixel(bits) / 2))
            .collect();
        // A flicker of this size is no temporal change, but would be one if the level were halved.
        let flicker =
            u16::try_from(design.temporal().level).unwrap_or(u16::MAX).min(largest_pixel(bits) / 2);
        Self { tiles, size, side: design.region_size(), bits, frame_number: 0, flicker, random }
    }

    /// Returns the next frame; every third one is noise.
    pub(super) fn next(&mut self) -> Frame {
        self.draw_frame(self.frame_number % NOISE_PERIOD == NOISE_PERIOD - 1)
    }

    /// Returns the next frame, which is noise all over.
    pub(super) fn noise_frame(&mut self) -> Frame {
        self.draw_frame(true)
    }

    /// Returns the next frame, in which a square of noise moves over a flickering background.
    pub(super) fn quiet_frame(&mut self) -> Frame {
        self.draw_frame(false)
    }

    /// Returns the next frame, whose background flickers by up to half the largest pixel, so that
    /// no change sets the highest bit.
    pub(super) fn flickering_frame(&mut self) -> Frame {
        let flicker = std::mem::replace(&mut self.flicker, largest_pixel(self.bits) / 2);
        let frame = self.quiet_frame();
        self.flicker = flicker;
        frame
    }

    fn drift_tiles(&mut self) {
        let most = largest_pixel(self.bits);
        for tile in &mut self.tiles {
            if self.random.one_in(DRIFT_PERIOD) {
                let (up, by) = (self.random.one_in(2), self.random.pixel(MAX_DRIFT.min(most / 4)));
                *tile = match up {
                    true => tile.saturating_add(by).min(most / 2),
                    false => tile.saturating_sub(by),
                };
            }
        }
    }

    /// Returns the gray level of the background at a pixel.
    fn background_pixel(&self, x: u32, y: u32) -> u16 {
        let start = |at: u32| at / self.side * self.side;
        let is_plain = x / self.side % 2 == 1;
        let (x, y) = if is_plain { (start(x), start(y)) } else { (x, y) };
        self.tiles[(y / TILE_SIDE * self.size.0.div_ceil(TILE_SIDE) + x / TILE_SIDE) as usize]
    }

    fn draw_frame(&mut self, is_noise: bool) -> Frame {
        let (width, height) = self.size;
        let (across, down) = (MOVING_SIDE.min(width), MOVING_SIDE.min(height));
        let from = (
            self.frame_number * 5 % (width - across + 1),
            self.frame_number * 3 % (height - down + 1),
        );
        self.frame_number += 1;
        self.drift_tiles();
        let mut pixels = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let inside = x.wrapping_sub(from.0) < across && y.wrapping_sub(from.1) < down;
                pixels.push(match inside || is_noise {
                    true => self.random.pixel(largest_pixel(self.bits)),
                    false => {
                        self.background_pixel(x, y).saturating_add(self.random.pixel(self.flicker))
                    }
                });
            }
        }
        Frame::new(width, height, self.bits, pixels).expect("pixels are at most the largest")
    }
}

/// Returns the largest pixel of `bits` bits.
pub(super) fn largest_pixel(bits: u32) -> u16 {
    u16::try_from((1_u32 << bits) - 1).expect("a pixel has at most 16 bits")
}
