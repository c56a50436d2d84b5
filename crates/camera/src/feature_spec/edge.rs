// SPDX-License-Identifier: MIT OR Apache-2.0
//! `edge`: the number of pixels with a strong gradient.

use super::{FeatureKind, FeatureSpec, LevelSpec, ScoreSource, ScoreUnit};

pub(super) const SPEC: FeatureSpec = FeatureSpec {
    summary: "pixels with a strong gradient",
    source: ScoreSource::WindowHits,
    unit: ScoreUnit::Pixels,
    level: Some(LevelSpec {
        default: 100,
        trial: &[50, 75, 100, 150],
        max: magnitude_max,
        largest_deciding: |pixel_max, _| Some(magnitude_max(pixel_max) - 1),
        random_divisor: 2,
    }),
    min_score: 5,
    scale: |_| 1,
    score_max: |numbers| numbers.n,
    companions: &[FeatureKind::Edge],
};

/// Returns the largest `|Gx| + |Gy|` of a 3x3 Sobel operator on pixels up to `pixel_max`.
///
/// The magnitude is `max(|Gx + Gy|, |Gx - Gy|)`, and both terms are
/// `2 * (three pixels - three others)`.
const fn magnitude_max(pixel_max: u32) -> u32 {
    6 * pixel_max
}
