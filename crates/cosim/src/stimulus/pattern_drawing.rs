// SPDX-License-Identifier: MIT OR Apache-2.0
//! The drawing of patterns, with differences and counts near the design's thresholds.

use super::random::Random;
use super::stimulus_pattern::{PatternGenerator, Texture, shift_pixel};

/// The rows of the tile of [`Texture::Mosaic`], with the left pixel in the highest bit. A search by
/// simulated annealing found it; no better tile is known.
const MOSAIC: [u8; 8] = [
    0b1010_1101,
    0b0010_1010,
    0b1110_1011,
    0b0001_0100,
    0b1110_1011,
    0b0001_0100,
    0b1101_0101,
    0b0100_1010,
];

impl PatternGenerator {
    /// Returns a square whose pixels are a function of the largest pixel and the place.
    pub(super) fn fill(&self, mut value: impl FnMut(u16, (usize, usize)) -> u16) -> Vec<u16> {
        let places = (0..self.side * self.side).map(|at| (at % self.side, at / self.side));
        places.map(|place| value(self.max, place)).collect()
    }

    /// Returns the index of a place among the pixels of the region, or `usize::MAX` for a place in
    /// the halo.
    pub(super) fn pixel_index(&self, at: usize) -> usize {
        let (x, y) = (at % self.side, at / self.side);
        let own = self.margin..self.side - self.margin;
        if own.contains(&x) && own.contains(&y) {
            (y - self.margin) * own.len() + x - self.margin
        } else {
            usize::MAX
        }
    }

    /// Returns the square with every pixel computed from its old value.
    pub(super) fn map_pixels(
        &mut self,
        mut pixels: Vec<u16>,
        mut value: impl FnMut(&mut Random, u16, u16) -> u16,
    ) -> Vec<u16> {
        for pixel in &mut pixels {
            *pixel = value(&mut self.random, self.max, *pixel);
        }
        pixels
    }

    /// Returns a difference between two pixels. Most differences meet a threshold, or miss it by
    /// one.
    pub(super) fn random_difference(&mut self) -> u16 {
        if self.random.one_in(4) {
            return self.random.pixel(self.max);
        }
        self.random.choose(&self.amounts).expect("there are some")
    }

    fn random_coordinate(&mut self) -> usize {
        self.random.index(self.side - 1)
    }

    /// Returns a difference between a pixel and its value in the last frame.
    pub(super) fn random_change(&mut self) -> u16 {
        if self.random.one_in(2) {
            return self.random_difference();
        }
        self.random.choose(&self.changes).expect("there are some")
    }

    /// Returns two values that differ by a chosen amount.
    pub(super) fn random_pair(&mut self) -> (u16, u16) {
        let amount = self.random_difference();
        let low = self.random.pixel(self.max - amount);
        if self.random.one_in(2) { (low, low + amount) } else { (low + amount, low) }
    }

    pub(super) fn texture(&self, texture: Texture) -> Vec<u16> {
        let side = self.side;
        self.fill(|max, (x, y)| {
            let extreme = |is_bright: bool| if is_bright { max } else { 0 };
            match texture {
                Texture::Checkers(size) => extreme((x / size + y / size) % 2 == 1),
                Texture::Columns(width) => extreme(x / width % 2 == 1),
                Texture::Rows(height) => extreme(y / height % 2 == 1),
                Texture::Dots(size, period) => extreme(x % period < size && y % period < size),
                Texture::Mosaic => extreme(MOSAIC[y % 8] >> (7 - x % 8) & 1 == 1),
                Texture::Halves => extreme(x >= side / 2),
                Texture::Quadrant => extreme(x < side / 2 && y < side / 2),
                Texture::Ramp => {
                    let level = usize::from(max) * (x + y) / (2 * side - 2);
                    u16::try_from(level).expect("no more than the largest")
                }
            }
        })
    }

    /// Draws blocks of 2x2 pixels over a square, which they replace.
    pub(super) fn blocks(&mut self, pixels: Vec<u16>) -> Vec<u16> {
        let noise = self.map_pixels(pixels, |random, max, _| random.pixel(max));
        self.fill(|_, (x, y)| noise[y / 2 * 2 * self.side + x / 2 * 2])
    }

    pub(super) fn hot_corner(&mut self) -> Vec<u16> {
        let (base, hot) = self.random_pair();
        let near = self.margin + usize::from(self.random.one_in(4));
        let mut end = || if self.random.one_in(2) { near } else { self.side - 1 - near };
        let spot = (end(), end());
        self.fill(|_, place| if place == spot { hot } else { base })
    }

    pub(super) fn step(&mut self) -> Vec<u16> {
        let (near, far) = self.random_pair();
        let (at, kind) = (self.random_coordinate() + 1, self.random.index(2));
        self.fill(|_, (x, y)| {
            let along = [x, y, (x + y) / 2][kind];
            if along < at { near } else { far }
        })
    }

    pub(super) fn quadrant(&mut self) -> Vec<u16> {
        let turn = self.quadrants;
        self.quadrants += 1;
        let (dark, right) = (turn % 2 == 1, turn / 2 % 2 == 1);
        let half = self.side / 2;
        self.fill(|max, (x, y)| if (y < half && (x < half) != right) != dark { max } else { 0 })
    }

    pub(super) fn ramp(&mut self) -> Vec<u16> {
        let steepest = usize::from(self.max) / (2 * self.side).max(1);
        let slope = usize::from(self.random_difference()).min(steepest).max(1);
        let (falls, diagonal) = (self.random.one_in(2), self.random.one_in(2));
        self.fill(|max, (x, y)| {
            let along = if diagonal { x + y } else { x };
            let value = u16::try_from(slope * along).unwrap_or(max).min(max);
            if falls { max - value } else { value }
        })
    }

    /// Draws a pixel with a ring of neighbors around it. `RING` has the neighbors clockwise from
    /// the upper left, as offsets from the upper left one.
    pub(super) fn ring(&mut self) -> Vec<u16> {
        const RING: [(usize, usize); 8] =
            [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)];
        let (center, around) = self.random_pair();
        let (first, length) = (self.random.index(7), 4 + self.random.index(4));
        let (x, y) = (self.random_coordinate(), self.random_coordinate());
        let mut pixels = self.fill(|_, _| center);
        for number in first..first + length {
            let (dx, dy) = RING[number % 8];
            let (x, y) = (x + dx, y + dy);
            if (1..=self.side).contains(&x) && (1..=self.side).contains(&y) {
                pixels[(y - 1) * self.side + x - 1] = around;
            }
        }
        pixels
    }

    /// Draws two adjacent levels, with as many pixels of each as needed for the mean to be just on,
    /// below or above the point at which it is rounded up.
    pub(super) fn half_mean(&mut self) -> Vec<u16> {
        let low = self.random.pixel(self.max - 1);
        let block = match self.block {
            Some(block) if self.random.one_in(2) => Some(block),
            _ => None,
        };
        let (count, unit) = block.map_or((self.count, self.mean_unit), |side| (side * side, 1));
        let wanted = [0, 1, count - 1];
        let remainder = |more: usize| (unit * more + count / 2) % count;
        let start = self.random.index(count);
        let more = (0..count).map(|step| (start + step) % count);
        let more =
            more.into_iter().find(|&more| wanted.contains(&remainder(more))).unwrap_or(start);
        let rank = |x: usize, y: usize| {
            let rank = self.pixel_index(y * self.side + x);
            block.map_or(rank, |side| self.in_block(rank, side).map_or(usize::MAX, |(_, at)| at))
        };
        self.fill(|_, (x, y)| if rank(x, y) < more { low + 1 } else { low })
    }

    /// Returns the block of a pixel of the region, and the index of the pixel in the block, or
    /// `None` for a pixel of the halo. Blocks have `side` pixels a side.
    fn in_block(&self, rank: usize, side: usize) -> Option<(usize, usize)> {
        let own = self.side - 2 * self.margin;
        let (x, y) = (rank % own, rank / own);
        let block = y / side * (own / side) + x / side;
        (rank < self.count).then_some((block, y % side * side + x % side))
    }

    /// Changes the mean of one block or of all. Most changes are upwards, so that they add up.
    pub(super) fn mean_step(&mut self, mut pixels: Vec<u16>) -> Vec<u16> {
        let side = self.block.unwrap_or(self.side);
        let last = (self.count / (side * side)).saturating_sub(1);
        let moving = match self.random.up_to(3) {
            0 => None,
            1 => Some(0),
            2 => Some(last),
            _ => Some(self.random.index(last)),
        };
        let amount = self.summary_level + u16::from(self.random.one_in(3));
        let up = !self.random.one_in(4);
        for (at, pixel) in pixels.iter_mut().enumerate() {
            let block = self.in_block(self.pixel_index(at), side).map(|(block, _)| block);
            if moving.is_none() || moving == block {
                *pixel = shift_pixel(*pixel, amount, up, self.max);
            }
        }
        pixels
    }

    pub(super) fn two_point(&mut self) -> Vec<u16> {
        let full = self.random.one_in(2);
        let (low, high) = if full { (0, self.max) } else { self.random_pair() };
        let any = self.random.index(self.count);
        let split = if full { self.count / 2 } else { any };
        self.fill(|_, (x, y)| if self.pixel_index(y * self.side + x) < split { low } else { high })
    }

    pub(super) fn smooth(&mut self) -> Vec<u16> {
        let mut corner = || i64::from(self.random.pixel(self.max));
        let (a, b, c, d) = (corner(), corner(), corner(), corner());
        let span = i64::try_from(self.side).expect("a square is small");
        self.fill(|_, (x, y)| {
            let (x, y) = [x, y].map(|at| i64::try_from(at).expect("a square is small")).into();
            let upper = a * (span - x) + b * x;
            let lower = c * (span - x) + d * x;
            let value = (upper * (span - y) + lower * y) / (span * span);
            u16::try_from(value).expect("between the corners")
        })
    }

    pub(super) fn bump(&mut self, mut pixels: Vec<u16>) -> Vec<u16> {
        let (amount, up) = (self.random_change(), self.random.one_in(2));
        let count = self.random.choose(&self.counts).expect("there are some") as usize;
        for (at, pixel) in pixels.iter_mut().enumerate() {
            if self.pixel_index(at) < count {
                *pixel = shift_pixel(*pixel, amount, up, self.max);
            }
        }
        pixels
    }

    pub(super) fn moving_pixel(&mut self, mut pixels: Vec<u16>) -> Vec<u16> {
        let amount = self.random_change();
        let (from, to) = (
            self.random_coordinate() * self.side + self.random_coordinate(),
            self.random_coordinate(),
        );
        let background = pixels[to];
        pixels[from] = background;
        let to = self.random_coordinate() * self.side + to;
        pixels[to] = shift_pixel(background, amount, true, self.max);
        pixels
    }

    /// Moves a picture by at most the radius in both directions, and not by 0.
    pub(super) fn moved(&mut self, before: &[u16]) -> Vec<u16> {
        let (side, radius) = (self.side, self.radius.min(self.side - 1));
        // The columns to the right, or the rows down, plus the radius.
        let mut shift = || self.random.index(2 * radius);
        let (mut columns, rows) = (shift(), shift());
        if (columns, rows) == (radius, radius) {
            columns += 1;
        }
        let is_new = self.random.one_in(2);
        let mut pixels = vec![0; before.len()];
        for (at, pixel) in pixels.iter_mut().enumerate() {
            let from = |to: usize, shift: usize| (to + radius).checked_sub(shift);
            let (x, y) = (from(at % side, columns), from(at / side, rows));
            let is_inside = |from: Option<usize>| from.is_some_and(|from| from < side);
            let nearest = |from: Option<usize>| from.unwrap_or(0).min(side - 1);
            *pixel = match is_new && !(is_inside(x) && is_inside(y)) {
                true => self.random.pixel(self.max),
                false => before[nearest(y) * side + nearest(x)],
            };
        }
        pixels
    }
}
