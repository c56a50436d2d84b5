// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pictures that a region of a bench shows in turn, and the thresholds under which they lead to
//! all kinds of decisions.

use super::drawn_places::flat_level;
use crate::stimulus::{
    PatternGenerator, PatternScores, StimulusPattern, Texture, ThresholdAimer, ThresholdRanges,
};
use foveate_camera::VoteCombination;
use foveate_design::{Design, ThresholdSource as Mode};
use foveate_model::ThresholdInputs;
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
