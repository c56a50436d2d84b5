// SPDX-License-Identifier: MIT OR Apache-2.0
//! `range`: the largest minus the smallest pixel.

use super::{FeatureKind, FeatureSpec, ScoreSource, ScoreUnit};

pub(super) const SPEC: FeatureSpec = FeatureSpec {
    summary: "brightest minus darkest pixel",
    source: ScoreSource::Extremes,
    unit: ScoreUnit::Levels,
    level: None,
    min_score: 20,
    scale: |_| 1,
    score_max: |numbers| numbers.pixel_max.into(),
    companions: &[FeatureKind::Range, FeatureKind::Mad],
};
