// SPDX-License-Identifier: MIT OR Apache-2.0
//! The contents of a region: the hard cases ([`StimulusPattern`]), each drawn into a square of
//! pixels with differences and counts near the design's thresholds ([`PatternGenerator`]).

use super::pattern_scorer::{PatternScorer, PatternScores};
use super::random::Random;
use foveate_camera::SpatialFeature;
use foveate_design::Design;
use foveate_model::ThresholdInputs;

/// A way to fill a square. Some patterns change the last picture of the square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StimulusPattern {
    /// All pixels are 0.
    Zero,
    /// All pixels have the largest value.
    Max,
    /// All pixels have one random level.
    Flat,
    /// A texture of 0 and the largest value.
    Texture(Texture),
    /// One pixel at a corner, or beside it, is above or below the others by a chosen amount.
    HotCorner,
    /// Two halves that differ by a chosen amount.
    Step,
    /// One quadrant has the largest value and the others 0, or the other way around, in turn. This
    /// gives the largest gradient in each direction, the strongest corner, and each time the
    /// largest change.
    Quadrant,
    /// A ramp of constant slope, so that every pixel is an edge.
    Ramp,
    /// A pixel with 4 to 8 contiguous neighbors that differ from it by a chosen amount.
    Ring,
    /// A mean whose fraction is one half, or misses it by one pixel; in turn of the region and of
    /// its blocks.
    HalfMean,
    /// Some pixels have one value, the others another; half of each gives the largest variance.
    TwoPoint,
    /// Independent random pixels of the whole range.
    Noise,
    /// Independent random blocks of 2x2 pixels, which a median filter keeps.
    Blocks,
    /// Independent random pixels of 0 and the largest value.
    Binary,
    /// A random and smooth surface.
    Smooth,
    /// The last picture.
    Same,
    /// The last picture, with some pixels off by one.
    Flicker,
    /// The last picture, one level brighter.
    Fade,
    /// The last picture, brighter or darker by a chosen amount.
    LightStep,
    /// The last picture, changed so that the mean of one block or of all just meets the summary
    /// level, or exceeds it.
    MeanStep,
    /// The last picture, with its first pixels changed: as many as the temporal minimum, or one
    /// off.
    Bump,
    /// The last picture, with one pixel moved.
    MovingPixel,
    /// The last picture, moved by at most the radius of `flow` and not by 0; the pixels that come
    /// in are new, or repeat the border.
    Moved,
}

/// A texture that is a function of the place and the largest pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Texture {
    /// Squares of `.0` pixels a side, alternately dark and bright.
    Checkers(usize),
    /// Dark and bright columns, each `.0` pixels wide.
    Columns(usize),
    /// Dark and bright rows, each `.0` pixels high.
    Rows(usize),
    /// Bright squares of `.0` pixels a side, with a period of `.1` pixels.
    Dots(usize, usize),
    /// A tile of 8x8 dark and bright pixels, repeated. In each direction of `surface`, at least 40
    /// of the 64 pixels of a tile differ from their neighbors if pixels repeat at the border of the
    /// tile, and at least 36 if other tiles surround it.
    Mosaic,
    /// A dark left half and a bright right half, which give the largest deviations.
    Halves,
    /// One bright quadrant.
    Quadrant,
    /// A ramp through all levels, from the upper left to the lower right corner.
    Ramp,
}

/// The patterns with which every frame differs from the last one in some regions and not in others.
pub(super) const VARYING_PATTERNS: &[StimulusPattern] = &[
    StimulusPattern::Smooth,
    StimulusPattern::Bump,
    StimulusPattern::Noise,
    StimulusPattern::Same,
    StimulusPattern::Step,
    StimulusPattern::Ring,
];

/// The number of squares that are tried to meet a minimum, or to be relevant.
const MAX_TRIALS: usize = 64;

/// The drawing state of one region.
#[derive(Clone, Debug)]
pub(crate) struct PatternGenerator {
    pub(super) side: usize,
    /// The width of the halo on each side, in pixels.
    pub(super) margin: usize,
    pub(super) max: u16,
    /// The number of pixels of the region.
    pub(super) count: usize,
    /// The side of a block with a mean, if regions have blocks.
    pub(super) block: Option<usize>,
    /// The weight of a pixel in the mean of the design, 2^f.
    pub(super) mean_unit: usize,
    pub(super) counts: Vec<u32>,
    pub(super) amounts: Vec<u16>,
    /// The changes that meet the temporal or the summary level, or miss it by one.
    pub(super) changes: Vec<u16>,
    /// The summary level, or 0 without summaries.
    pub(super) summary_level: u16,
    /// The number of quadrants drawn so far.
    pub(super) quadrants: usize,
    /// The largest movement in pixels: the radius of `flow`, or 1 without it.
    pub(super) radius: usize,
    /// The configured minima of the scores, and the one of changed pixels behind them.
    minima: Vec<u64>,
    configured: ThresholdInputs,
    scorer: PatternScorer,
    pub(crate) pixels: Vec<u16>,
    pub(super) random: Random,
}

impl PatternGenerator {
    /// Creates the state for squares of `side` pixels a side, with a black first picture.
    pub(crate) fn new(design: &Design, side: u32, random: Random) -> Self {
        let max = u16::try_from(design.pixel_max()).expect("a pixel has at most 16 bits");
        let (side, own) = (side as usize, design.region_size() as usize);
        let units = design.features().iter().filter_map(|feature| feature.mean());
        let fraction_bits = units.map(|mean| mean.fraction_bits).max();
        let levels = design.features().iter().filter_map(|feature| feature.level());
        let mut amounts = vec![1, 2.min(max), max / 2, max];
        for level in levels.chain([design.temporal().level]) {
            // A single pixel that is off by h has gradients of 2h around it. A straight step of h
            // has gradients of 4h, a diagonal one of 6h. Corners and changes are compared with h
            // itself.
            for part in [1, 2, 4, 6].map(|divisor| level / divisor) {
                let near = [part.saturating_sub(1), part, part + 1];
                amounts.extend(near.map(|h| u16::try_from(h).unwrap_or(max).min(max)));
            }
        }
        let level = design.temporal().level;
        let summary_level = design.periphery().map(|periphery| periphery.level);
        let near = |level: u32| [level.saturating_sub(1), level, level + 1];
        let changes = [level].into_iter().chain(summary_level).flat_map(near);
        let changes = changes.map(|h| u16::try_from(h).unwrap_or(max).min(max)).collect();
        let minima = design.features().iter().map(SpatialFeature::min_score);
        let minimum = design.temporal().min_count;
        let mut counts = vec![minimum.saturating_sub(1), minimum, minimum + 1];
        counts.extend(design.features().iter().filter_map(|f| u32::try_from(f.min_score()).ok()));
        Self {
            side,
            margin: side.saturating_sub(own) / 2,
            max,
            count: own * own,
            block: design.periphery().map(|periphery| periphery.block_side as usize),
            mean_unit: 1 << fraction_bits.unwrap_or(0),
            counts,
            amounts,
            changes,
            summary_level: summary_level.map_or(0, |level| u16::try_from(level).unwrap_or(max)),
            quadrants: 0,
            radius: design.displacement_feature().and_then(SpatialFeature::radius).unwrap_or(1)
                as usize,
            minima: minima.chain([minimum.into()]).collect(),
            configured: ThresholdInputs::from_camera(design),
            scorer: PatternScorer::for_design(design, side),
            pixels: vec![0; side * side],
            random,
        }
    }

    /// Draws the next picture over the last one.
    pub(crate) fn draw(&mut self, pattern: StimulusPattern) {
        let before = std::mem::take(&mut self.pixels);
        self.pixels = match pattern {
            StimulusPattern::Zero => self.fill(|_, _| 0),
            StimulusPattern::Max => self.fill(|max, _| max),
            StimulusPattern::Flat => {
                let level = self.random.pixel(self.max);
                self.fill(|_, _| level)
            }
            StimulusPattern::Texture(texture) => self.texture(texture),
            StimulusPattern::HotCorner => self.hot_corner(),
            StimulusPattern::Step => self.step(),
            StimulusPattern::Quadrant => self.quadrant(),
            StimulusPattern::Ramp => self.ramp(),
            StimulusPattern::Ring => self.ring(),
            StimulusPattern::HalfMean => self.half_mean(),
            StimulusPattern::TwoPoint => self.two_point(),
            StimulusPattern::Noise => self.map_pixels(before, |random, max, _| random.pixel(max)),
            StimulusPattern::Blocks => self.blocks(before),
            StimulusPattern::Binary => {
                let rarity = self.random.up_to(4) + 2;
                self.map_pixels(
                    before,
                    |random, max, _| if random.one_in(rarity) { max } else { 0 },
                )
            }
            StimulusPattern::Smooth => self.smooth(),
            StimulusPattern::Same => before,
            StimulusPattern::Flicker => {
                self.map_pixels(before, |random, max, pixel| match random.up_to(3) {
                    0 => pixel.saturating_sub(1),
                    1 => pixel.saturating_add(1).min(max),
                    _ => pixel,
                })
            }
            StimulusPattern::Fade => {
                self.map_pixels(before, |_, max, pixel| pixel.saturating_add(1).min(max))
            }
            StimulusPattern::LightStep => {
                let (amount, up) = (self.random_change(), self.random.one_in(2));
                self.map_pixels(before, |_, max, pixel| shift_pixel(pixel, amount, up, max))
            }
            StimulusPattern::MeanStep => self.mean_step(before),
            StimulusPattern::Bump => self.bump(before),
            StimulusPattern::MovingPixel => self.moving_pixel(before),
            StimulusPattern::Moved => self.moved(&before),
        };
    }

    /// Draws the next picture, then restores as many of the last pixels as needed for one of the
    /// scores, or for the number of changed pixels, to come as near as possible to its configured
    /// minimum, or to one less or more.
    pub(crate) fn draw_near_minimum(&mut self, pattern: StimulusPattern) {
        let before = self.pixels.clone();
        self.draw(pattern);
        let score_index = self.random.index(self.minima.len() - 1);
        let wanted = (self.minima[score_index] + self.random.up_to(2)).saturating_sub(1);
        let drawn = std::mem::take(&mut self.pixels);
        let step = self.count.div_ceil(MAX_TRIALS);
        let offset = self.random.index(step);
        let mixed = |kept: usize| -> Vec<u16> {
            let pairs = drawn.iter().zip(&before).enumerate();
            pairs
                .map(|(at, (&new, &old))| if self.pixel_index(at) < kept { new } else { old })
                .collect()
        };
        let trials: Vec<_> =
            (0..=self.count / step).map(|trial| mixed(offset + trial * step)).collect();
        let configured = self.configured;
        let scores_before = self.score(&before, &configured);
        let distance = |square: &Vec<u16>| {
            let now = self.score_after(square, &scores_before, &configured);
            let changes = || now.changed_pixels_from(&scores_before, &configured).into();
            now.scores.get(score_index).copied().unwrap_or_else(changes).abs_diff(wanted)
        };
        self.pixels = trials.into_iter().min_by_key(distance).expect("there is a first trial");
    }

    /// Draws noise until its region is relevant with the thresholds of the design, and returns
    /// true. After many trials it returns false. The pixels of neighbors are not known, so those of
    /// the border are repeated.
    pub(crate) fn draw_relevant_noise(&mut self) -> bool {
        (0..MAX_TRIALS).any(|_| {
            self.draw(StimulusPattern::Noise);
            self.scorer.score(&self.pixels, None, &self.configured).is_relevant
        })
    }

    /// Scores a square without a reference, and decides with these thresholds if its region is
    /// relevant.
    pub(crate) fn score(&mut self, square: &[u16], thresholds: &ThresholdInputs) -> PatternScores {
        self.scorer.score(square, None, thresholds)
    }

    /// Scores a square whose reference is another square.
    pub(crate) fn score_after(
        &mut self,
        square: &[u16],
        before: &PatternScores,
        thresholds: &ThresholdInputs,
    ) -> PatternScores {
        self.scorer.score(square, Some(before), thresholds)
    }

    /// Scores the picture that was drawn last. Its reference is another square.
    pub(crate) fn score_drawn_after(
        &mut self,
        before: &PatternScores,
        thresholds: &ThresholdInputs,
    ) -> PatternScores {
        self.scorer.score(&self.pixels, Some(before), thresholds)
    }
}

/// Returns a pixel that is brighter or darker by an amount; it is moved the other way if there is
/// no room.
pub(super) fn shift_pixel(pixel: u16, amount: u16, up: bool, max: u16) -> u16 {
    let (more, less) = (pixel.checked_add(amount).filter(|&v| v <= max), pixel.checked_sub(amount));
    let wanted = if up { more.or(less) } else { less.or(more) };
    wanted.unwrap_or(if up { max } else { 0 })
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::DesignConfig;
    use foveate_model::FunctionalCamera;
    use foveate_pixels::Frame;

    const ALL: [StimulusPattern; 30] = [
        StimulusPattern::Zero,
        StimulusPattern::Max,
        StimulusPattern::Flat,
        StimulusPattern::Texture(Texture::Checkers(1)),
        StimulusPattern::Texture(Texture::Columns(2)),
        StimulusPattern::Texture(Texture::Rows(3)),
        StimulusPattern::Texture(Texture::Dots(2, 4)),
        StimulusPattern::Texture(Texture::Mosaic),
        StimulusPattern::Texture(Texture::Halves),
        StimulusPattern::Texture(Texture::Quadrant),
        StimulusPattern::Texture(Texture::Ramp),
        StimulusPattern::HotCorner,
        StimulusPattern::Step,
        StimulusPattern::Quadrant,
        StimulusPattern::Ramp,
        StimulusPattern::Ring,
        StimulusPattern::HalfMean,
        StimulusPattern::TwoPoint,
        StimulusPattern::Noise,
        StimulusPattern::Blocks,
        StimulusPattern::Binary,
        StimulusPattern::Smooth,
        StimulusPattern::Same,
        StimulusPattern::Flicker,
        StimulusPattern::Fade,
        StimulusPattern::LightStep,
        StimulusPattern::MeanStep,
        StimulusPattern::Bump,
        StimulusPattern::MovingPixel,
        StimulusPattern::Moved,
    ];

    /// With 8x8 pixels of 8 bits the score of `surface` has 14 bits, and noise reaches 13 of them.
    #[test]
    fn the_mosaic_reaches_the_highest_bit_of_surface() {
        let toml = "frame={width=8,height=8}\ndenoise.filter='none'\nspatial=[{feature='surface'}]";
        let design = DesignConfig::from_toml(toml).unwrap().validate().unwrap();
        let mut generator = PatternGenerator::new(&design, 8, Random::new(1));
        generator.draw(StimulusPattern::Texture(Texture::Mosaic));
        let frame = Frame::new(8, 8, 8, generator.pixels.clone()).unwrap();
        let score = FunctionalCamera::new(&design).step(&frame).unwrap().scores[0][0];
        assert_eq!(score, 40 * 255);
        assert_eq!(design.features()[0].score_bits(), 14);
        assert!(score >= 1 << 13);
    }

    #[test]
    fn every_pattern_stays_in_range_at_every_size_and_depth() {
        for bits in [1, 2, 8, 12, 16] {
            for side in [2, 3, 5, 8, 12, 66] {
                let mut config = DesignConfig::default();
                config.camera.frame.pixel_bits = bits;
                config.camera.spatial[0].level = Some(1);
                config.camera.temporal.level = Some(u32::from(bits > 1));
                let design = config.validate().unwrap();
                let mut generator =
                    PatternGenerator::new(&design, side, Random::new(u64::from(bits * side)));
                for round in 0..60 {
                    generator.draw(ALL[round % ALL.len()]);
                    let count = (side * side) as usize;
                    assert_eq!(generator.pixels.len(), count);
                    let max = design.pixel_max();
                    assert!(generator.pixels.iter().all(|&pixel| u32::from(pixel) <= max));
                }
            }
        }
    }
}
