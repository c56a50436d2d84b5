// SPDX-License-Identifier: MIT OR Apache-2.0
//! `variance`: the mean squared deviation from the mean of the region.

use super::{FeatureKind, FeatureSpec, ScoreSource, ScoreUnit};

pub(super) const SPEC: FeatureSpec = FeatureSpec {
    summary: "mean squared distance from the mean",
    source: ScoreSource::Squares,
    unit: ScoreUnit::SquaredLevels,
    level: None,
    min_score: 50,
    scale: |numbers| numbers.n * numbers.n,
    score_max: |numbers| variance_score_max(numbers.n, numbers.pixel_max.into()),
    companions: &[FeatureKind::Variance, FeatureKind::Corner, FeatureKind::Edge, FeatureKind::Mad],
};

/// Returns the largest `n * sum(x^2) - sum(x)^2`, which half of the pixels at the maximum and the
/// others at zero give.
///
/// The expression is convex in every pixel, so it is largest when all are at an end of their range;
/// `k` pixels at the maximum give `pixel_max^2 * k * (n - k)`.
const fn variance_score_max(n: u64, pixel_max: u64) -> u64 {
    pixel_max * pixel_max * (n / 2) * n.div_ceil(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bits_for;
    use crate::feature_spec::tests::every_region;

    #[test]
    fn variance_maximum_is_reached_and_never_passed() {
        for (n, max) in [(4, 1), (4, 15), (9, 3), (16, 1), (25, 1)] {
            let mut best = 0;
            every_region(n, max, &mut |pixels| {
                let sum: u64 = pixels.iter().sum();
                let squares: u64 = pixels.iter().map(|x| x * x).sum();
                best = best.max(n as u64 * squares - sum * sum);
            });
            assert_eq!(variance_score_max(n as u64, max), best);
        }
    }

    #[test]
    fn the_largest_score_stays_in_64_bits() {
        assert_eq!(bits_for(variance_score_max(4096, 65535)), 54);
    }
}
