// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the decisions of a camera in some frames say about other frames: its flips, missed
//! regions and false alarms there ([`DecisionRates`]), and by how much such a figure may be
//! worse over as many other frames ([`group_margin`], [`share_of_others`]).

use crate::row::count_to_f64;
use foveate_inference::wilson_interval;
use foveate_measure::DecisionAreas;

/// The least number of regions that a share of missed regions or of false alarms needs.
pub(super) const MIN_REGIONS: f64 = 49.0;

/// The areas of a camera's decisions, in groups of consecutive frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DecisionGroups(pub(crate) Vec<DecisionAreas>);

/// A rate and what it is taken of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DecisionRate {
    /// The rate, 0..=1.
    pub(super) share: f64,
    /// The rate that 19 of 20 sets of as many other frames would not exceed, 0..=1.
    pub(super) expected: f64,
    /// The number of regions that the rate is a share of.
    pub(super) regions: f64,
}

/// The rates of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DecisionRates {
    pub(super) flips: DecisionRate,
    pub(super) missed: DecisionRate,
    pub(super) false_alarms: DecisionRate,
}

impl DecisionGroups {
    /// Sums the decisions of single frames of all clips.
    pub(crate) fn from_frames(frames: &[DecisionAreas]) -> Self {
        let mut groups = vec![DecisionAreas::default(); group_count(frames.len())];
        for (number, frame) in frames.iter().enumerate() {
            groups[frame_group(number, frames.len())].add(frame);
        }
        Self(groups)
    }

    /// Returns the rates. `sides` are the sides of the regions of the ideal and of the camera.
    pub(super) fn rates(&self, (ideal_side, side): (u32, u32)) -> DecisionRates {
        let (all, without) = (self.total(None), |group| self.total(Some(group)));
        let regions = |area: u64, side: u32| count_to_f64(area) / f64::from(side * side);
        let rate = |of: fn(&DecisionAreas) -> f64, regions: f64, largest: fn(f64, f64) -> f64| {
            let share = of(&all);
            let by_groups = share + group_margin(self.0.len(), |group| of(&without(group)));
            let expected = by_groups.max(largest(share, regions)).min(1.0);
            DecisionRate { share, expected, regions }
        };
        let by_count = |share, regions| share_of_others(share, regions)[1];
        DecisionRates {
            flips: rate(DecisionAreas::flips, regions(all.active.all, ideal_side), |share, _| {
                share
            }),
            missed: rate(DecisionAreas::missed, regions(all.later.ideal, ideal_side), by_count),
            false_alarms: rate(
                DecisionAreas::false_alarms,
                regions(all.later.candidate, side),
                by_count,
            ),
        }
    }

    /// Returns the sum of all groups, without one that is left out.
    pub(crate) fn total(&self, left_out: Option<usize>) -> DecisionAreas {
        let mut total = DecisionAreas::default();
        let kept = self.0.iter().enumerate().filter(|(group, _)| Some(*group) != left_out);
        kept.for_each(|(_, group)| total.add(group));
        total
    }
}

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

/// Returns by how much a figure over as many other frames may be worse, from its values without
/// each of the groups; 0 if there are fewer than two groups.
pub(crate) fn group_margin(groups: usize, without: impl Fn(usize) -> f64) -> f64 {
    if groups < 2 {
        return 0.0;
    }
    // Two sets of frames differ from each other by more than one set differs from the truth: by the
    // square root of 2.
    STUDENT_QUANTILES[groups - 2] * 2.0_f64.sqrt() * jackknife(groups, without)
}

/// Returns the least and the largest share that as many other things are likely to have, even if
/// all groups happen to be alike: Wilson's interval for the difference of two shares.
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
    use foveate_measure::ActiveAreas;

    /// Two groups of 100 regions of 2x2 pixels: in one of them nothing flips and nothing is missed,
    /// in the other one 10 regions flip, 5 of 50 active regions are missed, and 20 of 65 are false
    /// alarms.
    #[test]
    fn rates_have_the_worse_of_two_margins() {
        let group = |action: u64, both: u64, candidate: u64| {
            let later =
                ActiveAreas { all: 400, ideal: 4 * 50, candidate: 4 * candidate, both: 4 * both };
            DecisionAreas { action: 4 * action, active: later, later, ..DecisionAreas::default() }
        };
        let decisions = DecisionGroups(vec![group(0, 50, 50), group(10, 45, 65)]);
        let DecisionRates { flips, missed, false_alarms } = decisions.rates((2, 2));
        assert_eq!((flips.share, flips.regions), (0.05, 200.0));
        // With two groups the jackknife is half of their difference, and t is 6.314.
        assert!((flips.expected - (0.05 + 6.314 * 2.0_f64.sqrt() * 0.05)).abs() < 1e-12);
        assert_eq!((missed.share, missed.regions), (0.05, 100.0));
        assert!((missed.expected - (0.05 + 6.314 * 2.0_f64.sqrt() * 0.05)).abs() < 1e-12);
        assert_eq!((false_alarms.share, false_alarms.regions), (20.0 / 115.0, 115.0));
        assert!(false_alarms.expected <= 1.0 && false_alarms.expected > 0.9);
        // Equal groups have no jackknife; the number of regions still leaves a margin.
        let equal = DecisionGroups(vec![group(10, 45, 65); 2]).rates((2, 2));
        assert_eq!(equal.flips.expected, equal.flips.share);
        assert_eq!(equal.missed.expected, share_of_others(0.1, 100.0)[1]);
    }

    #[test]
    fn frames_are_in_groups_of_neighbors() {
        let frame = |srs: u64| DecisionAreas { srs, ..DecisionAreas::default() };
        let frames: Vec<_> = (0..20).map(|number| frame(1 << number)).collect();
        let DecisionGroups(groups) = DecisionGroups::from_frames(&frames);
        let areas: Vec<u64> = groups.iter().map(|group| group.srs).collect();
        assert_eq!(areas[..3], [0b111, 0b11000, 0b1110_0000]);
        assert_eq!(areas.iter().sum::<u64>(), (1 << 20) - 1);
    }

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
