// SPDX-License-Identifier: MIT OR Apache-2.0
//! The flips, missed regions and false alarms of a camera in a part of all clips, and the rates to
//! expect of other frames.

use foveate_measure::DecisionAreas;

use super::sampling_error::{frame_group, group_count, group_margin, share_of_others};
use crate::row::count_to_f64;

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

#[cfg(test)]
mod tests {
    use foveate_measure::ActiveAreas;

    use super::*;

    /// Two groups of 100 regions of 2x2 pixels: in one of them nothing flips and nothing is missed, in the other
    /// one 10 regions flip, 5 of 50 active regions are missed, and 20 of 65 are false alarms.
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
}
