// SPDX-License-Identifier: MIT OR Apache-2.0
//! The decision, which is combinational: it depends on the score ports and the thresholds of the
//! clock.

use super::plan::{FEATURES, RpuPlan};
use crate::Thresholds;
use crate::decision::combined;

/// The relevance bits of a valid decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Decision {
    pub(super) srs: bool,
    pub(super) trs: bool,
}

impl Decision {
    pub(super) fn of(
        plan: &RpuPlan,
        scores: &[u64; FEATURES],
        temporal_count: u32,
        thresholds: &Thresholds,
    ) -> Self {
        let votes = plan
            .features
            .iter()
            .zip(scores.iter().zip(&thresholds.min_score))
            .filter_map(|(kind, (score, min))| kind.map(|_| score >= min));
        Self {
            srs: combined(plan.combine, votes),
            trs: temporal_count >= thresholds.temporal_min_count,
        }
    }

    pub(super) fn active(self) -> bool {
        self.srs && self.trs
    }
}
