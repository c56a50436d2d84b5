// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores of test pictures of one region under the thresholds of the design, and the
//! differences between two of them.

use foveate_design::{Design, VoteCombination};
use foveate_model::{RegionScorer, ThresholdInputs};

/// The border mask of a region that is alone in its frame: it touches all four sides.
const ALL_SIDES: u8 = 0b1111;

/// A scorer of pictures of single regions.
pub(super) struct PictureScorer {
    scorer: RegionScorer,
    side: usize,
    halo: usize,
    features: usize,
    combine: VoteCombination,
}

/// The scores of a picture of one region.
#[derive(Clone, Debug)]
pub(super) struct PictureScores {
    pub(super) scores: Vec<u64>,
    pub(super) is_relevant: bool,
    /// The denoised pixels, which are compared from frame to frame.
    pub(super) denoised: Vec<u16>,
}

impl PictureScorer {
    pub(super) fn new(design: &Design) -> Self {
        Self {
            scorer: RegionScorer::new(design),
            side: design.region_size() as usize,
            halo: design.halo() as usize,
            features: design.features().len(),
            combine: design.combine(),
        }
    }

    /// Scores a picture that follows `before`, and decides with these thresholds if it is relevant.
    pub(super) fn score_picture(
        &mut self,
        picture: &[u16],
        before: Option<&PictureScores>,
        thresholds: &ThresholdInputs,
    ) -> PictureScores {
        let (side, halo) = (self.side, self.halo);
        // Pixels beyond the frame repeat its border.
        let inside = |at: usize| at.saturating_sub(halo).min(side - 1);
        let reach = side + 2 * halo;
        let places = (0..reach * reach).map(|at| (inside(at % reach), inside(at / reach)));
        self.scorer.load(places.map(|(x, y)| picture[y * side + x]), ALL_SIDES);
        let reference = before.map(|before| before.denoised.as_slice());
        let scores = self.scorer.scores(reference, thresholds)[..self.features].to_vec();
        let mut votes = scores.iter().zip(&thresholds.min_score).map(|(score, min)| score >= min);
        let is_relevant = match self.combine {
            VoteCombination::Any => votes.any(|vote| vote),
            VoteCombination::All => votes.all(|vote| vote),
        };
        PictureScores { scores, is_relevant, denoised: self.scorer.pixels().collect() }
    }
}

impl PictureScores {
    /// Returns the number of pixels that differ from another picture by more than the temporal
    /// level.
    pub(super) fn changed_pixels_from(&self, before: &Self, thresholds: &ThresholdInputs) -> u32 {
        let pairs = self.denoised.iter().zip(&before.denoised);
        let differs = |(now, then): &(&u16, &u16)| {
            u32::from(now.abs_diff(**then)) > thresholds.temporal_level
        };
        u32::try_from(pairs.filter(differs).count()).expect("at most the pixels of a region")
    }
}
