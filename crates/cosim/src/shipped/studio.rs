// SPDX-License-Identifier: MIT OR Apache-2.0
//! Looks at pictures with the eyes of the design: which are relevant, and how far two differ.

use foveate_design::{Combine, Design};
use foveate_model::{RegionScorer, Thresholds};

/// A region alone in its frame has the frame's border on all sides.
const ALL_SIDES: u8 = 0b1111;

/// Scores pictures of single regions.
pub(super) struct Studio {
    scorer: RegionScorer,
    side: usize,
    halo: usize,
    features: usize,
    combine: Combine,
}

/// What a picture of one region comes to.
#[derive(Clone, Debug)]
pub(super) struct Look {
    pub(super) scores: Vec<u64>,
    pub(super) is_relevant: bool,
    /// The pixels that are compared from frame to frame.
    pub(super) denoised: Vec<u16>,
}

impl Studio {
    pub(super) fn new(design: &Design) -> Self {
        Self {
            scorer: RegionScorer::new(design),
            side: design.region_size() as usize,
            halo: design.halo() as usize,
            features: design.features().len(),
            combine: design.combine(),
        }
    }

    /// Scores a picture that follows another, and says what becomes of it with these thresholds.
    pub(super) fn look(
        &mut self,
        picture: &[u16],
        before: Option<&Look>,
        thresholds: &Thresholds,
    ) -> Look {
        let (side, halo) = (self.side, self.halo);
        // Beyond the frame its border repeats.
        let inside = |at: usize| at.saturating_sub(halo).min(side - 1);
        let reach = side + 2 * halo;
        let places = (0..reach * reach).map(|at| (inside(at % reach), inside(at / reach)));
        self.scorer.take(places.map(|(x, y)| picture[y * side + x]), ALL_SIDES);
        let reference = before.map(|before| before.denoised.as_slice());
        let scores = self.scorer.scores(reference, thresholds)[..self.features].to_vec();
        let mut votes = scores.iter().zip(&thresholds.min_score).map(|(score, min)| score >= min);
        let is_relevant = match self.combine {
            Combine::Any => votes.any(|vote| vote),
            Combine::All => votes.all(|vote| vote),
        };
        Look { scores, is_relevant, denoised: self.scorer.pixels().collect() }
    }
}

impl Look {
    /// Pixels that differ from another picture by more than the level.
    pub(super) fn changes(&self, before: &Self, thresholds: &Thresholds) -> u32 {
        let pairs = self.denoised.iter().zip(&before.denoised);
        let differs = |(now, then): &(&u16, &u16)| {
            u32::from(now.abs_diff(**then)) > thresholds.temporal_level
        };
        u32::try_from(pairs.filter(differs).count()).expect("at most the pixels of a region")
    }
}
