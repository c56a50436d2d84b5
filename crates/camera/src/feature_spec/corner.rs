// SPDX-License-Identifier: MIT OR Apache-2.0
//! `corner`: the number of pixels with five adjacent neighbors that are all brighter or all darker.

use super::{FeatureKind, FeatureSpec, LevelSpec, ScoreSource, ScoreUnit};

pub(super) const SPEC: FeatureSpec = FeatureSpec {
    summary: "pixels that are corners",
    source: ScoreSource::WindowHits,
    unit: ScoreUnit::Pixels,
    level: Some(LevelSpec {
        default: 20,
        trial: &[8, 12, 20, 30],
        max: |pixel_max| pixel_max,
        largest_deciding: |pixel_max, _| Some(pixel_max - 1),
        random_divisor: 2,
    }),
    min_score: 5,
    scale: |_| 1,
    score_max: |numbers| numbers.n,
    companions: &[FeatureKind::Edge, FeatureKind::Corner],
};
