// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scores and the decision of one region in one frame.

use foveate_camera::{Camera, FeatureKind, RegionClass};

use super::region::combine_votes;
use crate::RegionScorer;
use crate::conversions::index;
use crate::thresholds::ClassThresholdInputs;

/// The scores and the decision of one region in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RegionDecision {
    pub(crate) scores: [u64; FeatureKind::COUNT],
    pub(crate) temporal_count: u32,
    pub(crate) srs: bool,
    pub(crate) trs: bool,
}

impl RegionDecision {
    /// Scores and decides the region that the scorer has taken, by the rules of its class.
    /// `reference` is `None` if there is no valid one.
    pub(crate) fn from_scorer(
        camera: &Camera,
        scorer: &RegionScorer,
        reference: Option<&[u16]>,
        (class, thresholds): (RegionClass, ClassThresholdInputs<'_>),
    ) -> Self {
        let thresholds = thresholds.of(class);
        let scores = scorer.scores(reference, thresholds);
        let temporal_count = scorer.temporal_count(reference, thresholds);
        let minima = camera.features().iter().zip(&thresholds.min_score);
        let votes = minima.zip(&scores).map(|((_, min), score)| score >= min);
        let voted = combine_votes(camera.combine(), votes);
        Self {
            scores,
            temporal_count,
            srs: class.forced_srs().unwrap_or(voted),
            trs: temporal_count >= thresholds.temporal_min_count,
        }
    }

    pub(crate) fn is_active(&self) -> bool {
        self.srs && self.trs
    }

    /// Returns a score by its number: 0 for the temporal count, 1.. for the features.
    pub(crate) fn score(&self, number: u32) -> u64 {
        match number.checked_sub(1) {
            None => self.temporal_count.into(),
            Some(feature) => self.scores[index(feature)],
        }
    }
}
