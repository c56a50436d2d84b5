// SPDX-License-Identifier: MIT OR Apache-2.0
//! By how much a figure over some frames may differ from the same figure over as many other frames.

use foveate_inference::wilson_interval;

/// The number of groups of consecutive frames: consecutive frames show the same objects, so they
/// are not independent.
pub(super) const FRAME_GROUPS: usize = 8;
/// The quantiles of Student's t for 1 and more degrees of freedom: 19 of 20 values are above the
/// negative of them.
const STUDENT_QUANTILES: [f64; FRAME_GROUPS - 1] =
    [6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895];
/// The quantile of a normal variable: 19 of 20 values are above the negative of it.
const NORMAL_QUANTILE: f64 = 1.645;

/// Returns the number of groups of so many frames.
pub(super) fn group_count(frames: usize) -> usize {
    frames.min(FRAME_GROUPS)
}

/// Returns the group of a frame, given by its number among all frames of a part of the clips.
pub(super) fn frame_group(number: usize, frames: usize) -> usize {
    number * group_count(frames) / frames
}

/// Returns by how much a figure over as many other frames may be worse, from its values without each
/// of the groups; 0 if there are fewer than two groups.
pub(crate) fn group_margin(groups: usize, without: impl Fn(usize) -> f64) -> f64 {
    if groups < 2 {
        return 0.0;
    }
    // Two sets of frames differ from each other by more than one set differs from the truth: by the
    // square root of 2.
    STUDENT_QUANTILES[groups - 2] * 2.0_f64.sqrt() * jackknife(groups, without)
}

/// Returns the least and the largest share that as many other things are likely to have, even if all
/// groups happen to be alike: Wilson's interval for the difference of two shares.
pub(super) fn share_of_others(share: f64, count: f64) -> [f64; 2] {
    let half = count / 2.0;
    if half == 0.0 { [share; 2] } else { wilson_interval(share, half, NORMAL_QUANTILE) }
}

/// Returns the standard error of a figure over some groups, from its values without each of the
/// groups (jackknife).
fn jackknife(groups: usize, without: impl Fn(usize) -> f64) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "a small number")]
    let count = groups as f64;
    let figures: Vec<f64> = (0..groups).map(without).collect();
    let mean = figures.iter().sum::<f64>() / count;
    let squares: f64 = figures.iter().map(|figure| (figure - mean).powi(2)).sum();
    ((count - 1.0) / count * squares).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The standard error of a mean is the standard deviation over the square root of the number of
    /// values.
    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let values: [f64; 5] = [1.0, 0.5, 1.0, 0.75, 0.25];
        let sum: f64 = values.iter().sum();
        let found = jackknife(5, |left_out| (sum - values[left_out]) / 4.0);
        let squares: f64 = values.iter().map(|value| (value - sum / 5.0).powi(2)).sum();
        assert!((found - (squares / 4.0 / 5.0).sqrt()).abs() < 1e-12, "{found}");
        assert_eq!(jackknife(4, |_| 0.9), 0.0);
    }

    /// Even if all groups are alike, a share of few things is uncertain: the bound is the least
    /// share that a test would not distinguish from the observed share.
    #[test]
    fn few_things_say_little_of_others() {
        for (share, count) in [(0.976, 251_u32), (1.0, 20), (0.5, 7)] {
            let [found, _] = share_of_others(share, count.into());
            let error = (found * (1.0 - found) * 2.0 / f64::from(count)).sqrt();
            assert!(
                (share - found - NORMAL_QUANTILE * error).abs() < 1e-9,
                "{share} of {count}: {found}"
            );
        }
        assert!(share_of_others(0.98, 99.0)[0] < share_of_others(0.98, 990.0)[0]);
        assert_eq!((share_of_others(0.0, 9.0)[0], share_of_others(0.9, 0.0)), (0.0, [0.9; 2]));
    }
}
