// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores of squares of pixels, for squares that meet a minimum exactly or are relevant. They
//! only affect the choice of vectors; the expected outputs come from the model of a core.

use foveate_camera::{ReferencePolicy, VoteCombination};
use foveate_design::Design;
use foveate_model::{RegionScorer, ThresholdInputs};

/// The border mask of a region that is alone in its frame: it touches all four sides.
const ALL_SIDES: u8 = 0b1111;

/// A scorer of squares of one size: regions, or regions with their halo.
#[derive(Clone, Debug)]
pub(super) struct PatternScorer {
    scorer: RegionScorer,
    side: usize,
    /// The number of pixels that are added on each side, because pixels beyond the frame repeat its
    /// border.
    added: usize,
    feature_count: usize,
    combine: VoteCombination,
    /// True if a region may lack a reference after the first frame. A picture then counts as
    /// relevant only if it is relevant with and without a reference.
    may_lack_reference: bool,
}

/// The scores of a square.
#[derive(Clone, Debug)]
pub(crate) struct PatternScores {
    /// The score of each feature of the design.
    pub(crate) scores: Vec<u64>,
    pub(crate) is_relevant: bool,
    /// The denoised pixels of the region, which are compared from frame to frame.
    denoised: Vec<u16>,
}

impl PatternScorer {
    pub(super) fn for_design(design: &Design, side: usize) -> Self {
        Self {
            scorer: RegionScorer::new(design),
            side,
            added: (design.stream_side() as usize).saturating_sub(side) / 2,
            feature_count: design.features().len(),
            combine: design.combine(),
            may_lack_reference: match design.temporal().reference {
                ReferencePolicy::Previous => false,
                ReferencePolicy::LastSent => true,
            },
        }
    }

    /// Scores a square, and decides with these thresholds if its region is relevant. The reference
    /// is the square `before`, if there is one.
    pub(super) fn score(
        &mut self,
        square: &[u16],
        before: Option<&PatternScores>,
        thresholds: &ThresholdInputs,
    ) -> PatternScores {
        let (side, added) = (self.side, self.added);
        let inside = |at: usize| at.saturating_sub(added).min(side - 1);
        let width = side + 2 * added;
        let places = (0..width * width).map(|at| (inside(at % width), inside(at / width)));
        self.scorer.load(places.map(|(x, y)| square[y * side + x]), ALL_SIDES);
        let reference = before.map(|before| before.denoised.as_slice());
        let scores_with =
            |reference| self.scorer.scores(reference, thresholds)[..self.feature_count].to_vec();
        let is_relevant = |scores: &[u64]| {
            let mut votes =
                scores.iter().zip(&thresholds.min_score).map(|(score, min)| score >= min);
            match self.combine {
                VoteCombination::Any => votes.any(|vote| vote),
                VoteCombination::All => votes.all(|vote| vote),
            }
        };
        let scores = scores_with(reference);
        let is_relevant =
            is_relevant(&scores) && (!self.may_lack_reference || is_relevant(&scores_with(None)));
        PatternScores { scores, is_relevant, denoised: self.scorer.pixels().collect() }
    }
}

impl PatternScores {
    /// Returns the number of pixels that differ from an earlier square by more than the temporal
    /// level.
    pub(crate) fn changed_pixels_from(&self, before: &Self, thresholds: &ThresholdInputs) -> u32 {
        let pairs = self.denoised.iter().zip(&before.denoised);
        let differs = |(now, then): &(&u16, &u16)| {
            u32::from(now.abs_diff(**then)) > thresholds.temporal_level
        };
        u32::try_from(pairs.filter(differs).count()).expect("at most the pixels of a region")
    }
}
