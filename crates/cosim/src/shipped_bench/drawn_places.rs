// SPDX-License-Identifier: MIT OR Apache-2.0
//! The places of a frame at which regions of a bench have structure, and the ground elsewhere.

use foveate_design::Design;
use foveate_pixels::Frame;

/// The largest number of pixels in those regions of a frame that show more than one level.
const MAX_DRAWN_PIXELS: u32 = 16_384;
/// The number of regions from which on a frame has a varying ground. A word that is stored or read
/// at a wrong place then shows wherever that is.
const MANY_REGIONS: u32 = 256;
/// The number of regions of such a frame for each drawn region.
const REGIONS_PER_DRAWN_REGION: u32 = 64;
/// The number of blocks of the ground in each direction; `GROUND_LEVELS` is the number of their
/// levels.
const GROUND_BLOCKS: u32 = 8;
const GROUND_LEVELS: u32 = 4;

/// The places in a frame at which regions have structure.
pub(super) struct DrawnPlaces<'a> {
    part: &'a Design,
    /// The indices of the regions with structure, in ascending order.
    pub(super) places: Vec<u32>,
    pub(super) side: usize,
    pub(super) max: u16,
    /// The level of a flat region.
    flat: u16,
}

impl<'a> DrawnPlaces<'a> {
    /// Creates the places: all regions of a small array, or else evenly spread regions, with the
    /// first and the last one among them.
    pub(super) fn new(part: &'a Design) -> Self {
        let regions = part.regions();
        let least = (MAX_DRAWN_PIXELS / part.region_pixels()).clamp(6, 48);
        let count = least.max(regions / REGIONS_PER_DRAWN_REGION).min(regions);
        let last = u64::from(count - 1).max(1);
        let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
        let place = |number: u32| {
            let place = u64::from(number) * u64::from(regions - 1) / last;
            u32::try_from(place).expect("a region of the array")
        };
        Self {
            part,
            places: (0..count).map(place).collect(),
            side: part.region_size() as usize,
            max,
            flat: flat_level(part),
        }
    }

    /// Returns a frame with the given squares at the places, and the ground of this turn elsewhere.
    pub(super) fn frame(&self, squares: &[Vec<u16>], turn: u32) -> Frame {
        let (part, side) = (self.part, self.part.region_size());
        let pixel = |x: u32, y: u32| {
            let region = y / side * part.columns() + x / side;
            match self.places.binary_search(&region) {
                Ok(at) => squares[at][(y % side * side + x % side) as usize],
                Err(_) => self.ground_level(x / side, y / side, turn),
            }
        };
        self.frame_from_pixels(pixel)
    }

    /// Returns true if the ground differs from place to place and from turn to turn.
    pub(super) fn has_ground(&self) -> bool {
        self.part.regions() >= MANY_REGIONS
    }

    /// Returns the level of a flat region. In a frame with many regions it is one of a few levels,
    /// by blocks of regions.
    fn ground_level(&self, column: u32, row: u32, turn: u32) -> u16 {
        if !self.has_ground() {
            return self.flat;
        }
        let block = column * GROUND_BLOCKS / self.part.columns();
        let mixed = (row * GROUND_BLOCKS + block).wrapping_mul(0x9e37_79b9) >> 16;
        let level = (mixed + turn * (1 + mixed / GROUND_LEVELS % 2)) % GROUND_LEVELS;
        let level = level * u32::from(self.max) / (GROUND_LEVELS - 1);
        u16::try_from(level).expect("no more than the largest")
    }

    /// Returns a frame with squares all over, shifted from turn to turn. Their edges and corners
    /// reach every region, and a median filter keeps them.
    pub(super) fn wide_frame(&self, turn: u32) -> Frame {
        let size = (self.part.region_size() / 2).max(3);
        let is_bright = |at: u32, shift: u32| (at + shift) % (2 * size) < size;
        let pixel = |x, y| match is_bright(x, turn) && is_bright(y, turn * 2 % 7) {
            true => self.max,
            false => 0,
        };
        self.frame_from_pixels(pixel)
    }

    fn frame_from_pixels(&self, pixel: impl FnMut(u32, u32) -> u16) -> Frame {
        let part = self.part;
        Frame::from_fn(part.width(), part.height(), part.pixel_bits(), pixel)
            .unwrap_or_else(|error| unreachable!("pixels are those of the design: {error}"))
    }
}

/// Returns the level of a flat region of a frame with few regions.
pub(super) fn flat_level(part: &Design) -> u16 {
    u16::try_from(part.pixel_max() / 3).expect("a pixel has at most 16 bits")
}
