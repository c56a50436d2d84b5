// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pictures that a region of a bench shows in turn, and the thresholds under which they lead to
//! all kinds of decisions.

use super::picture_scorer::{PictureScorer, PictureScores};
use super::test_pattern::{STRUCTURED_PATTERNS, TestPattern};
use crate::field::low_bits_mask;
use crate::situations::largest_min_count;
use crate::stimulus::Random;
use foveate_design::{Design, ThresholdSource as Mode, VoteCombination};
use foveate_model::ThresholdInputs;
use std::ops::RangeInclusive;

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
        let scores = self.scores.iter().zip(part.features());
        for (minimum, (&score, feature)) in exact.min_score.iter_mut().zip(scores) {
            *minimum = (score + u64::from(more)).min(low_bits_mask(feature.score_bits()));
        }
        exact.temporal_min_count = (self.changes + more).min(largest_min_count(part));
        exact
    }
}

/// Returns the thresholds of the design if some test pictures lead to all kinds of regions under
/// them. Otherwise, if thresholds are inputs, it returns the smallest ones that distinguish a
/// pattern from a flat region.
pub(super) fn threshold_pair(
    part: &Design,
    studio: &mut PictureScorer,
    random: &mut Random,
) -> ThresholdPair {
    let own = ThresholdInputs::from_camera(part);
    let configured = ThresholdPair { usual: own, blank: own };
    match part.threshold_source() {
        Mode::Constant => configured,
        Mode::Runtime if separates_regions(part, studio, &own, random) => configured,
        Mode::Runtime => smallest_thresholds(part, studio, random),
    }
}

/// Returns true if some pattern is relevant, a flat region is not, and an unchanged region is held.
fn separates_regions(
    part: &Design,
    studio: &mut PictureScorer,
    thresholds: &ThresholdInputs,
    random: &mut Random,
) -> bool {
    let (side, max) = region_shape(part);
    let flat = TestPattern::Flat.draw(side, max, false, random);
    let flat = studio.score_picture(&flat, None, thresholds);
    let least = thresholds.temporal_min_count;
    let mut good = STRUCTURED_PATTERNS.iter().filter(|texture| {
        let picture = texture.draw(side, max, false, random);
        let look = studio.score_picture(&picture, Some(&flat), thresholds);
        look.is_relevant && look.changed_pixels_from(&flat, thresholds) >= least
    });
    !flat.is_relevant && least > 0 && good.next().is_some()
}

/// Returns thresholds with levels of 0 and minima of 1. A feature that never finds anything
/// (corners in 2x2 pixels behind a median filter) gets a minimum of 0 if its vote is needed.
fn smallest_thresholds(
    part: &Design,
    studio: &mut PictureScorer,
    random: &mut Random,
) -> ThresholdPair {
    let (side, max) = region_shape(part);
    let mut blank = ThresholdInputs::from_camera(part);
    (blank.temporal_level, blank.temporal_min_count) = (0, 1);
    for (level, minimum) in blank.level.iter_mut().zip(&mut blank.min_score) {
        (*level, *minimum) = (0, 1);
    }
    let mut usual = blank;
    let looks: Vec<PictureScores> = STRUCTURED_PATTERNS
        .iter()
        .map(|texture| studio.score_picture(&texture.draw(side, max, false, random), None, &blank))
        .collect();
    let is_needed = part.combine() == VoteCombination::All || part.features().len() == 1;
    for (feature, minimum) in usual.min_score.iter_mut().enumerate().take(part.features().len()) {
        if is_needed && looks.iter().all(|look| look.scores[feature] == 0) {
            *minimum = 0;
        }
    }
    ThresholdPair { usual, blank }
}

/// Returns the pictures of a region: relevant ones, each with enough changes against the picture
/// before it.
pub(super) fn draw_region(
    part: &Design,
    studio: &mut PictureScorer,
    thresholds: &ThresholdInputs,
    number: usize,
    random: &mut Random,
) -> DrawnRegion {
    let (side, max) = region_shape(part);
    let flat = TestPattern::Flat.draw(side, max, false, random);
    let nothing = studio.score_picture(&flat, None, thresholds);
    let least = thresholds.temporal_min_count;
    let mut pick = |from: usize, before: &PictureScores, wanted: RangeInclusive<u32>| {
        for step in 0..2 * TRIALS_PER_PATTERN * STRUCTURED_PATTERNS.len() {
            let texture = STRUCTURED_PATTERNS
                [(from + step / (2 * TRIALS_PER_PATTERN)) % STRUCTURED_PATTERNS.len()];
            let picture = texture.draw(side, max, step % 2 == 1, random);
            let look = studio.score_picture(&picture, Some(before), thresholds);
            let changes = look.changed_pixels_from(before, thresholds);
            if look.is_relevant && wanted.contains(&changes) {
                return Some((picture, look));
            }
        }
        None
    };
    let all = part.region_pixels();
    // Without a reference every pixel counts as changed.
    let first = pick(number, &nothing, 0..=all);
    let (first, seen) = first.unwrap_or_else(|| (flat.clone(), nothing.clone()));
    // A change of some pixels is preferred to a change of all.
    let other = pick(number + 1, &seen, least..=all - 1);
    let other = other.or_else(|| pick(number + 1, &seen, least..=all));
    let last = pick(number + 2, &nothing, least..=all).map_or_else(|| first.clone(), |last| last.0);
    let (other, look) = other.unwrap_or_else(|| {
        let negative: Vec<u16> = first.iter().map(|&pixel| max - pixel).collect();
        let look = studio.score_picture(&negative, Some(&seen), thresholds);
        (negative, look)
    });
    let (changes, scores) = (look.changed_pixels_from(&seen, thresholds), look.scores);
    DrawnRegion { first, other, last, scores, changes }
}

fn region_shape(part: &Design) -> (usize, u16) {
    let max = u16::try_from(part.pixel_max()).expect("a pixel has at most 16 bits");
    (part.region_size() as usize, max)
}
