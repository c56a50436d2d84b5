// SPDX-License-Identifier: MIT OR Apache-2.0
//! `segment`: the pixels of the smaller of two parts, one brighter and one darker than the mean.

use super::{FeatureKind, FeatureSpec, LevelSpec, ScoreSource, ScoreUnit};

pub(super) const SPEC: FeatureSpec = FeatureSpec {
    summary: "two parts of different brightness",
    source: ScoreSource::Deviations,
    unit: ScoreUnit::Pixels,
    level: Some(LevelSpec {
        default: 8,
        trial: &[4, 8, 12, 20],
        max: |pixel_max| pixel_max,
        largest_deciding,
        random_divisor: 4,
    }),
    min_score: 8,
    scale: |_| 1,
    score_max: |numbers| numbers.n / 2,
    companions: &[FeatureKind::Segment, FeatureKind::Corner, FeatureKind::Mad],
};

/// The mean must be more than the level away from both ends of the range of pixels. It is a whole
/// number if it has no fraction bits.
fn largest_deciding(pixel_max: u32, fraction_bits: u32) -> Option<u32> {
    ((pixel_max - 1) / 2).checked_sub(u32::from(fraction_bits == 0))
}
