// SPDX-License-Identifier: MIT OR Apache-2.0
//! The decision, which is combinational: it depends on the score ports and the thresholds of the
//! clock.

use foveate_camera::RegionClass;

use super::rpu_parameters::{MAX_FEATURES, RpuParameters};
use crate::ThresholdInputs;
use crate::decision::combine_votes;

/// The relevance bits of a valid decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RelevanceBits {
    pub(super) srs: bool,
    pub(super) trs: bool,
}

impl RelevanceBits {
    pub(super) fn from_scores(
        plan: &RpuParameters,
        scores: &[u64; MAX_FEATURES],
        temporal_count: u32,
        thresholds: &ThresholdInputs,
    ) -> Self {
        let votes = plan
            .features
            .iter()
            .zip(scores.iter().zip(&thresholds.min_score))
            .filter_map(|(kind, (score, min))| kind.map(|_| score >= min));
        Self {
            srs: combine_votes(plan.combine, votes),
            trs: temporal_count >= thresholds.temporal_min_count,
        }
    }

    /// Returns the bits of a region of this class.
    pub(super) fn of_class(self, class: RegionClass) -> Self {
        Self { srs: class.forced_srs().unwrap_or(self.srs), ..self }
    }

    pub(super) fn is_active(self) -> bool {
        self.srs && self.trs
    }
}
