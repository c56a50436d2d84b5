// SPDX-License-Identifier: MIT OR Apache-2.0
//! `mad`: the mean absolute deviation from the mean of the region.

use super::{FeatureKind, FeatureSpec, ScoreSource, ScoreUnit};

pub(super) const SPEC: FeatureSpec = FeatureSpec {
    summary: "mean distance from the mean",
    source: ScoreSource::Deviations,
    unit: ScoreUnit::Levels,
    level: None,
    min_score: 5,
    scale: |numbers| numbers.n << numbers.fraction_bits,
    score_max: |numbers| mad_score_max(numbers.n, numbers.pixel_max.into(), numbers.fraction_bits),
    companions: &[FeatureKind::Mad, FeatureKind::Edge],
};

/// Returns the rounded mean of `n` pixels with the sum `sum`, in units of `2^-fraction_bits`.
const fn rounded_mean(n: u64, sum: u64, fraction_bits: u32) -> u64 {
    ((sum << fraction_bits) + n / 2) / n
}

/// Returns the largest `sum |2^f * x - mu|` over all regions of `n` pixels in `0..=pixel_max`.
///
/// For a fixed sum the score is convex in the pixels, so it is largest where all pixels but one are
/// at an end of their range: `k` at the maximum, one at `v`, the others at zero. For a fixed `k`
/// and a fixed mean the score is convex in `v` too, so only the ends of the interval of `v` with
/// that mean count. A `k` far from `n / 2` is left out when `mad_bound` is below the best score
/// found.
fn mad_score_max(n: u64, pixel_max: u64, fraction_bits: u32) -> u64 {
    let top = pixel_max << fraction_bits;
    let mut best = 0;
    for distance in 0..=n / 2 {
        if mad_bound(n, top, distance) < u128::from(best) {
            break;
        }
        for k in [n / 2 - distance, (n / 2 + distance).min(n - 1)] {
            best = best.max(mad_max_with(n, pixel_max, fraction_bits, k));
        }
    }
    best
}

/// Returns an upper bound of the score with `k = n/2 -+ distance` pixels at the maximum. The
/// deviation from the exact mean is at most `2 * top * k' * (n - k') / n` for some `k'` in
/// `k..=k + 1` (two-point distribution). The rounding of the mean adds at most `distance + 1`. The
/// bound is concave in `distance`, so once it is below a score that is reached it stays below.
fn mad_bound(n: u64, top: u64, distance: u64) -> u128 {
    let near = u128::from((n / 2).saturating_sub(distance.saturating_sub(1)));
    let exact = (2 * u128::from(top) * near * (u128::from(n) - near)).div_ceil(u128::from(n));
    exact + u128::from(distance) + 2
}

/// Returns the largest score with exactly `k` pixels at the maximum and at most one between.
fn mad_max_with(n: u64, pixel_max: u64, fraction_bits: u32, k: u64) -> u64 {
    let top = pixel_max << fraction_bits;
    let mut best = 0;
    let mut v = 0;
    while v <= pixel_max {
        let sum = k * pixel_max + v;
        let mean = rounded_mean(n, sum, fraction_bits);
        // `last` is the largest `v` that rounds to this mean.
        let last_sum = (((mean + 1) * n - n / 2).div_ceil(1 << fraction_bits)) - 1;
        let last = (last_sum - k * pixel_max).min(pixel_max);
        for end in [v, last] {
            let others = k * (top - mean) + (n - k - 1) * mean;
            best = best.max(others + (end << fraction_bits).abs_diff(mean));
        }
        v = last + 1;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feature_spec::tests::every_region;

    fn mad_score(pixels: &[u64], f: u32) -> u64 {
        let n = pixels.len() as u64;
        let mean = rounded_mean(n, pixels.iter().sum(), f);
        pixels.iter().map(|x| (x << f).abs_diff(mean)).sum()
    }

    #[test]
    fn mad_maximum_is_reached_and_never_passed() {
        for (n, max) in [(4, 1), (4, 3), (4, 15), (9, 1), (9, 3), (9, 4), (16, 1), (25, 1), (16, 2)]
        {
            for f in 0..=5 {
                let mut best = 0;
                every_region(n, max, &mut |pixels| best = best.max(mad_score(pixels, f)));
                assert_eq!(mad_score_max(n as u64, max, f), best, "n {n} max {max} f {f}");
            }
        }
    }

    #[test]
    fn the_largest_score_stays_in_64_bits() {
        assert_eq!(mad_score_max(4096, 65535, 12), 2048 * (65535 << 12));
    }
}
