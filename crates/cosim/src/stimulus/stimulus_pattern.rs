// SPDX-License-Identifier: MIT OR Apache-2.0
//! The contents of a region: the hard cases, each drawn into a square of pixels.

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
    /// A tile of 8x8 dark and bright pixels, repeated. In each direction of `surface`, at least 40 of
    /// the 64 pixels of a tile differ from their neighbors if pixels repeat at the border of the tile,
    /// and at least 36 if other tiles surround it.
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

    /// Draws noise until its region is relevant with the thresholds of the design, and returns true.
    /// After many trials it returns false. The pixels of neighbors are not known, so those of the
    /// border are repeated.
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
