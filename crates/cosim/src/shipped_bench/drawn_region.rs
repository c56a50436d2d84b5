// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the bench of a core shows to it, chosen so that all kinds of decisions occur in few
//! clocks: the part of the core that is simulated ([`bench_design`]), the places of a frame
//! that have structure ([`DrawnPlaces`]), and the pictures of a region in turn
//! ([`DrawnRegion`]) with the thresholds under which they lead to these decisions
//! ([`ThresholdPair`]).

use crate::error::CosimError;
use crate::level::CosimLevel;
use crate::stimulus::{
    PatternGenerator, PatternScores, StimulusPattern, Texture, ThresholdAimer, ThresholdRanges,
};
use foveate_camera::{Neighborhood, VoteCombination};
use foveate_design::{ArrayStructure, Design, ThresholdSource as Mode};
use foveate_emit::Top;
use foveate_model::ThresholdInputs;
use foveate_pixels::Frame;
use std::ops::RangeInclusive;

/// The patterns with some structure; those with the most different values come first.
const STRUCTURED_PATTERNS: &[StimulusPattern] = &[
    StimulusPattern::Noise,
    StimulusPattern::Blocks,
    StimulusPattern::Texture(Texture::Quadrant),
    StimulusPattern::Texture(Texture::Ramp),
    StimulusPattern::Texture(Texture::Dots(1, 3)),
    StimulusPattern::Texture(Texture::Dots(3, 5)),
    StimulusPattern::Texture(Texture::Dots(2, 4)),
    StimulusPattern::Texture(Texture::Halves),
    StimulusPattern::Texture(Texture::Checkers(1)),
    StimulusPattern::Texture(Texture::Checkers(2)),
    StimulusPattern::Texture(Texture::Columns(1)),
    StimulusPattern::Texture(Texture::Columns(2)),
    StimulusPattern::Texture(Texture::Rows(1)),
    StimulusPattern::Texture(Texture::Rows(2)),
    StimulusPattern::Texture(Texture::Columns(3)),
    StimulusPattern::Texture(Texture::Rows(3)),
    StimulusPattern::Texture(Texture::Checkers(3)),
];

/// The number of times that a pattern is drawn anew before the next pattern is tried.
const TRIALS_PER_PATTERN: usize = 2;

/// Two sets of thresholds: with `usual` some regions are relevant, with `blank` a flat region is
/// not.
#[derive(Clone, Copy)]
pub(super) struct ThresholdPair {
    pub(super) usual: ThresholdInputs,
    pub(super) blank: ThresholdInputs,
}

/// A region with structure, and the pictures that it shows in turn.
pub(super) struct DrawnRegion {
    pub(super) first: Vec<u16>,
    pub(super) other: Vec<u16>,
    pub(super) last: Vec<u16>,
    /// The scores of `other`; `changes` is the number of pixels in which it differs from `first`.
    scores: Vec<u64>,
    changes: u32,
}

impl DrawnRegion {
    /// Returns minima that `other` meets exactly (`more` is 0), or misses by `more` if the ports
    /// are wide enough.
    pub(super) fn exact_thresholds(
        &self,
        part: &Design,
        usual: &ThresholdInputs,
        more: u32,
    ) -> ThresholdInputs {
        let mut exact = *usual;
        ThresholdRanges::of(part).set_minima((&self.scores, self.changes), more, &mut exact);
        exact
    }
}

/// Returns the thresholds of the design if some patterns lead to all kinds of regions under them.
/// Otherwise, if thresholds are inputs, it returns the smallest ones that distinguish a pattern
/// from a flat region.
pub(super) fn threshold_pair(part: &Design, generator: &mut PatternGenerator) -> ThresholdPair {
    let own = ThresholdInputs::from_camera(part);
    let configured = ThresholdPair { usual: own, blank: own };
    let mut pair = match part.threshold_source() {
        Mode::Constant => return configured,
        Mode::Runtime if separates_regions(part, generator, &own) => configured,
        Mode::Runtime => smallest_thresholds(part, generator),
    };
    if part.displacement_feature().is_some() {
        // A flat region behind one with structure may have a displacement.
        ThresholdRanges::of(part).set_largest_minima(&mut pair.blank);
    }
    pair
}

/// Returns true if some pattern is relevant, a flat region is not, and an unchanged region is held.
fn separates_regions(
    part: &Design,
    generator: &mut PatternGenerator,
    thresholds: &ThresholdInputs,
) -> bool {
    let flat = generator.score(&flat_square(part), thresholds);
    let least = thresholds.temporal_min_count;
    let mut good = STRUCTURED_PATTERNS.iter().filter(|&&pattern| {
        generator.draw(pattern);
        let scores = generator.score_drawn_after(&flat, thresholds);
        scores.is_relevant && scores.changed_pixels_from(&flat, thresholds) >= least
    });
    let has_good = good.next().is_some();
    !flat.is_relevant && least > 0 && has_good
}

/// Returns thresholds with levels of 0 and minima of 1. A feature that never finds anything
/// (corners in 2x2 pixels behind a median filter) gets a minimum of 0 if its vote is needed.
fn smallest_thresholds(part: &Design, generator: &mut PatternGenerator) -> ThresholdPair {
    let ThresholdInputs { summary_level, .. } = ThresholdInputs::from_camera(part);
    let blank = ThresholdInputs { summary_level, ..ThresholdAimer::smallest_thresholds() };
    let mut usual = blank;
    let flat = generator.score(&flat_square(part), &blank);
    let scored: Vec<PatternScores> = STRUCTURED_PATTERNS
        .iter()
        .map(|&pattern| {
            generator.draw(pattern);
            generator.score_drawn_after(&flat, &blank)
        })
        .collect();
    let is_needed = part.combine() == VoteCombination::All || part.features().len() == 1;
    for (feature, minimum) in usual.min_score.iter_mut().enumerate().take(part.features().len()) {
        if is_needed && scored.iter().all(|own| own.scores[feature] == 0) {
            *minimum = 0;
        }
    }
    ThresholdPair { usual, blank }
}

/// Returns the pictures of a region: relevant ones, each with enough changes against the picture
/// before it.
pub(super) fn draw_region(
    part: &Design,
    generator: &mut PatternGenerator,
    thresholds: &ThresholdInputs,
    number: usize,
) -> DrawnRegion {
    let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
    let negative = |picture: &[u16]| picture.iter().map(|&pixel| max - pixel).collect::<Vec<_>>();
    let flat = flat_square(part);
    let nothing = generator.score(&flat, thresholds);
    let least = thresholds.temporal_min_count;
    // The last pixels of a picture are `kept`.
    let mut pick =
        |from: usize, before: &PatternScores, wanted: RangeInclusive<u32>, kept: &[u16]| {
            for step in 0..2 * TRIALS_PER_PATTERN * STRUCTURED_PATTERNS.len() {
                let place = (from + step / (2 * TRIALS_PER_PATTERN)) % STRUCTURED_PATTERNS.len();
                generator.draw(STRUCTURED_PATTERNS[place]);
                let drawn = generator.pixels.clone();
                let mut picture = if step % 2 == 1 { negative(&drawn) } else { drawn };
                picture.truncate(picture.len() - kept.len());
                picture.extend(kept);
                let scores = generator.score_after(&picture, before, thresholds);
                let changes = scores.changed_pixels_from(before, thresholds);
                if scores.is_relevant && wanted.contains(&changes) {
                    return Some((picture, scores));
                }
            }
            None
        };
    let all = part.region_pixels();
    // Without a reference every pixel counts as changed.
    let first = pick(number, &nothing, 0..=all, &[]);
    let (first, first_scores) = first.unwrap_or_else(|| (flat.clone(), nothing.clone()));
    // A change of some pixels is preferred to a change of all. It shows that there is a reference.
    let half = &first[first.len() / 2..];
    let other = pick(number + 1, &first_scores, least..=all - 1, &[])
        .or_else(|| pick(number + 1, &first_scores, least..=all - 1, half))
        .or_else(|| pick(number + 1, &first_scores, least..=all, &[]));
    let last = pick(number + 2, &nothing, least..=all, &[]);
    let last = last.map_or_else(|| first.clone(), |last| last.0);
    let (other, scores) = other.unwrap_or_else(|| {
        let other = negative(&first);
        let scores = generator.score_after(&other, &first_scores, thresholds);
        (other, scores)
    });
    let changes = scores.changed_pixels_from(&first_scores, thresholds);
    DrawnRegion { first, other, last, scores: scores.scores, changes }
}

/// Returns the pixels of a flat region.
pub(super) fn flat_square(part: &Design) -> Vec<u16> {
    vec![flat_level(part); part.region_pixels() as usize]
}

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

/// The smallest side of a region at which an array of nine is too slow in Icarus.
const LARGE_SIDE: u32 = 32;
/// The largest number of slots per lane at which two full lanes are simulated.
const MANY_SLOTS: u32 = 1024;

/// Returns the design for the grid that the bench of `top` simulates: for `rpu` one region or lane,
/// for `rcm` the whole frame, because widths, memories and counters follow from its size. If the
/// array is copies of `rpu`, or has more lanes than a simulator can build, the grid of `rcm` is
/// small. It has more than two lanes and, with `shared` neighborhoods and small regions, a region
/// with neighbors on all sides.
pub(super) fn bench_design(design: &Design, top: Top) -> Result<Design, CosimError> {
    match top {
        Top::Rpu => match design.unit().array {
            ArrayStructure::RpuCopies => {
                Ok(CosimLevel::Rcm { columns: 1, rows: 1 }.design(design)?)
            }
            ArrayStructure::SharedLogic => Ok(design.lone_unit()),
        },
        Top::Rcm if CosimLevel::is_whole_affordable(design) => Ok(design.clone()),
        Top::Rcm => {
            let (least, rows) = grid_size(design);
            let part = |columns| CosimLevel::Rcm { columns, rows }.design(design);
            // The grid of a small array may be smaller than the organization allows.
            let taken = (least..design.columns()).find_map(|columns| part(columns).ok());
            Ok(taken.map_or_else(|| part(design.columns()), Ok)?)
        }
    }
}

fn grid_size(design: &Design) -> (u32, u32) {
    let (columns, rows) = (design.columns(), design.rows());
    let least = match design.neighborhood() {
        Neighborhood::Shared if design.region_size() < LARGE_SIDE => 9,
        Neighborhood::Shared | Neighborhood::Isolated => 4,
    };
    let fold = design.slots();
    // The array has two full lanes and a third one that is half full, or one full lane and some
    // slots.
    let lanes = if fold <= MANY_SLOTS { 2 * fold + fold.div_ceil(2) } else { fold + least };
    let wanted = lanes.max(least).min(columns * rows);
    let side = (1..=columns).find(|side| side * side >= wanted).unwrap_or(columns);
    // A region can be lost only if the array has one row more than wait for the sink.
    let kept = design.timing().departure().buffered_rows.map_or(0, |kept| kept + 1);
    let high = wanted.div_ceil(side).max(kept).min(rows);
    (wanted.div_ceil(high).min(columns), high)
}
