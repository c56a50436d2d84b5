// SPDX-License-Identifier: MIT OR Apache-2.0
//! `flow`: the gain of the best displacement of the region from its reference.

use super::{FeatureKind, FeatureSpec, RegionNumbers, ScoreSource, ScoreUnit};

pub(super) const SPEC: FeatureSpec = FeatureSpec {
    summary: "the content has moved",
    source: ScoreSource::Reference,
    unit: ScoreUnit::Levels,
    level: None,
    min_score: 2,
    scale: |numbers| numbers.n,
    score_max: RegionNumbers::pixel_sum_max,
    companions: &[FeatureKind::Flow, FeatureKind::Edge],
};
