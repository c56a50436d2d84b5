// SPDX-License-Identifier: MIT OR Apache-2.0
//! `surface`: how little the region resembles itself, displaced by one pixel.

use super::{FeatureKind, FeatureSpec, RegionNumbers, ScoreSource, ScoreUnit};

pub(super) const SPEC: FeatureSpec = FeatureSpec {
    summary: "how little the region resembles itself, displaced",
    source: ScoreSource::WindowSums { sums: 4 },
    unit: ScoreUnit::Levels,
    level: None,
    min_score: 5,
    scale: |numbers| numbers.n,
    score_max: RegionNumbers::pixel_sum_max,
    companions: &[FeatureKind::Surface, FeatureKind::Edge],
};
