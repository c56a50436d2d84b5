// SPDX-License-Identifier: MIT OR Apache-2.0
//! The objectives that points are compared by ([`Objective`]), and the points that win: the
//! Pareto fronts of two objectives, which no other point beats ([`mark_fronts`]). Tables, plots
//! and the page take from here in which direction a figure is better.

use crate::row::{DesignRow, FrontMembership, count_to_f64};

/// A figure by which points are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Objective {
    /// The error: the share of flipped actions, 0..=1.
    Error,
    /// The frames per second at the clock of each design.
    Speed,
    /// The frames per clock, if no clock is known.
    PerClock,
    /// The share of the device that the array takes, as `fit` counts it, 0..=1.
    DeviceShare,
    /// The area of the array in the cells of a process, in square millimetres.
    Mm2,
    /// The energy of a region in a frame, in the cells of a process, in nanojoules.
    Energy,
    /// The share of the relevant regions that are stale, 0..=1.
    Stale,
    /// The bytes per frame that leave the array.
    Bytes,
    /// The SSIM of the screen against the ideal's screen, at most 1.
    Ssim,
}

/// The direction in which a figure is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BetterDirection {
    Smaller,
    Larger,
}

impl Objective {
    pub(crate) fn better_direction(self) -> BetterDirection {
        match self {
            Self::Error
            | Self::DeviceShare
            | Self::Mm2
            | Self::Energy
            | Self::Stale
            | Self::Bytes => BetterDirection::Smaller,
            Self::Speed | Self::PerClock | Self::Ssim => BetterDirection::Larger,
        }
    }

    /// Returns the figure of a point; `None` if it is not known.
    pub(crate) fn value_of(self, row: &DesignRow) -> Option<f64> {
        match self {
            Self::Error => Some(row.figures.action_flips),
            Self::Speed => row.speed.map(|speed| speed.frames_per_second),
            Self::PerClock => Some(1.0 / count_to_f64(row.clocks_per_frame)),
            Self::DeviceShare => row.device_share,
            Self::Mm2 => row.process.as_ref().and_then(|process| process.mm2),
            Self::Energy => row.energy().map(|energy| energy.nj_per_region),
            Self::Stale => Some(row.figures.stale_regions),
            Self::Bytes => Some(row.bytes_per_frame),
            Self::Ssim => Some(row.figures.ssim_ideal),
        }
    }

    /// Returns the figure as a cost, which is better the smaller it is.
    fn cost_of(self, row: &DesignRow) -> Option<f64> {
        self.value_of(row).map(|value| match self.better_direction() {
            BetterDirection::Smaller => value,
            BetterDirection::Larger => -value,
        })
    }
}

/// The objectives of the fronts of an exploration, besides the error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FrontObjectives {
    /// The frames per second, or the frames per clock if no clock is known.
    pub(crate) speed: Objective,
    /// The area: square millimetres with a process, the share of the device without one.
    pub(crate) area: Objective,
    pub(crate) has_areas: bool,
}

impl FrontObjectives {
    /// Returns the objectives of some points. `has_process` is true if they were to be mapped to
    /// the cells of a process.
    pub(crate) fn of_rows(rows: &[DesignRow], has_process: bool) -> Self {
        let has_clocks = rows.iter().any(|row| row.speed.is_some());
        let area = if has_process { Objective::Mm2 } else { Objective::DeviceShare };
        Self {
            speed: if has_clocks { Objective::Speed } else { Objective::PerClock },
            area,
            has_areas: rows.iter().any(|row| area.value_of(row).is_some()),
        }
    }
}

/// Returns whether each point is unbeaten: it [qualifies](DesignRow::qualifies), and no other such
/// point is as good in both objectives and better in one.
pub(crate) fn unbeaten_rows(rows: &[&DesignRow], objectives: [Objective; 2]) -> Vec<bool> {
    let costs = |row: &&DesignRow| {
        objectives.map(|objective| objective.cost_of(row).filter(|_| row.qualifies()))
    };
    pareto_front(&rows.iter().map(costs).collect::<Vec<_>>())
}

/// Marks the fronts of an exploration. `has_process` is true if its points were to be mapped to the
/// cells of a process.
pub(crate) fn mark_fronts(rows: &mut [DesignRow], has_process: bool) {
    let FrontObjectives { speed, area, .. } = FrontObjectives::of_rows(rows, has_process);
    let all: Vec<&DesignRow> = rows.iter().collect();
    let front = |objective| unbeaten_rows(&all, [Objective::Error, objective]);
    let fronts = [speed, area, Objective::Energy].map(front);
    for (index, row) in rows.iter_mut().enumerate() {
        let [speed, area, energy] = [0, 1, 2].map(|front| fronts[front][index]);
        row.front = FrontMembership { speed, area, energy };
    }
}

/// Returns whether each point is on the front of its two costs: no other point has costs that are
/// both at most as high and one of them lower. A point without a cost, or with NaN as a cost, is on
/// no front and beats no point.
pub(crate) fn pareto_front(points: &[[Option<f64>; 2]]) -> Vec<bool> {
    let known = |(index, [first, second]): (usize, &[Option<f64>; 2])| {
        // Adding zero turns -0 into 0.
        let (first, second) = ((*first)? + 0.0, (*second)? + 0.0);
        (!first.is_nan() && !second.is_nan()).then_some((first, second, index))
    };
    let mut known: Vec<_> = points.iter().enumerate().filter_map(known).collect();
    known.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)));
    let (mut on_front, mut last) = (vec![false; points.len()], None);
    // A point that beats another one comes before it; equal points do not beat each other.
    for (first, second, index) in known {
        if last.is_none_or(|(x, y)| second < y || (first, second) == (x, y)) {
            (on_front[index], last) = (true, Some((first, second)));
        }
    }
    on_front
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::sample_exploration;
    use crate::{ProcessEnergy, ProcessFigures};
    use foveate_estimate::FrameRate;

    /// Makes points with figures from a few values, so that many are equal. Some points have no
    /// clock, no area or no figures in a process, and some miss too much.
    fn points(seed: u64) -> Vec<DesignRow> {
        let row = sample_exploration("", true).rows.remove(0);
        let mut chance = fastrand::Rng::with_seed(seed);
        let mut point = || {
            let mut row = row.clone();
            row.figures.action_flips = f64::from(chance.u32(0..6)) / 10.0;
            row.figures.missed = f64::from(chance.u32(5..12)) / 100.0;
            row.figures.false_alarms = f64::from(chance.u32(5..12)) / 100.0;
            row.clocks_per_frame = chance.u64(1..12);
            let mhz = f64::from(chance.u32(1..4));
            row.speed =
                (chance.u8(0..5) > 0).then(|| FrameRate::at_given_clock(mhz, row.clocks_per_frame));
            row.device_share = (chance.u8(0..5) > 0).then(|| f64::from(chance.u32(1..12)));
            row.process = (chance.u8(0..5) > 0).then(|| ProcessFigures {
                library: "cells".to_owned(),
                unit_um2: 1.0,
                mm2: (chance.u8(0..5) > 0).then(|| f64::from(chance.u32(1..9))),
                memory_bits_without_macro: 0,
                clock_mhz: 1.0,
                energy: (chance.u8(0..3) > 0).then(|| ProcessEnergy {
                    frame_rate: 30.0,
                    nj_per_region: f64::from(chance.u32(1..9)),
                    usual_mw: f64::from(chance.u32(1..9)),
                    busiest_mw: f64::from(chance.u32(1..9)),
                }),
            });
            row
        };
        (0..60).map(|_| point()).collect()
    }

    /// The definition of a front: the point has the cost and at most 10 % missed and false alarms,
    /// and no other such point has neither more flips nor a higher cost, and one of them lower.
    fn front(rows: &[DesignRow], cost: &dyn Fn(&DesignRow) -> Option<f64>) -> Vec<bool> {
        let costs = |row: &DesignRow| {
            let figures = &row.figures;
            let is_useful = figures.missed <= 0.1 && figures.false_alarms <= 0.1;
            is_useful.then_some((figures.action_flips, cost(row)?))
        };
        let beats = |one: (f64, f64), other| one != other && one.0 <= other.0 && one.1 <= other.1;
        let is_on = |row| {
            costs(row).is_some_and(|own| !rows.iter().filter_map(costs).any(|one| beats(one, own)))
        };
        rows.iter().map(is_on).collect()
    }

    #[test]
    fn every_front_is_that_of_its_own_figures() {
        let (mut told_apart, mut unknown) = ([0; 2], 0);
        for (seed, has_process) in (0..200).flat_map(|seed| [(seed, false), (seed, true)]) {
            let mut rows = points(seed);
            mark_fronts(&mut rows, has_process);
            let pace = |row: &DesignRow| row.speed.map(|speed| -speed.frames_per_second);
            let area = |row: &DesignRow| match has_process {
                true => row.process.as_ref()?.mm2,
                false => row.device_share,
            };
            let energy = |row: &DesignRow| Some(row.process.as_ref()?.energy?.nj_per_region);
            let [pace, small, frugal] =
                [&pace as &dyn Fn(&DesignRow) -> Option<f64>, &area, &energy]
                    .map(|cost| front(&rows, cost));
            for (index, row) in rows.iter().enumerate() {
                let (speed, area, energy) = (pace[index], small[index], frugal[index]);
                let expected = FrontMembership { speed, area, energy };
                assert_eq!(row.front, expected, "seed {seed}, {has_process}: {row:?}");
                told_apart[0] += usize::from(speed != area);
                told_apart[1] += usize::from(area != energy);
                unknown += usize::from(row.device_share.is_none() && speed);
            }
        }
        // Without many such points the test would not notice if two fronts were swapped.
        assert!(told_apart.iter().all(|count| *count > 500) && unknown > 0);
    }

    #[test]
    fn without_clocks_fewer_clocks_per_frame_are_faster() {
        let mut rows = points(1);
        rows.iter_mut().for_each(|row| row.speed = None);
        mark_fronts(&mut rows, false);
        let fast = front(&rows, &|row| Some(count_to_f64(row.clocks_per_frame)));
        assert_eq!(rows.iter().map(|row| row.front.speed).collect::<Vec<_>>(), fast);
    }

    #[test]
    fn what_nothing_beats_is_on_the_front() {
        let points = [
            [Some(1.0), Some(9.0)],
            [Some(2.0), Some(2.0)],
            [Some(2.0), Some(3.0)],
            [Some(9.0), Some(1.0)],
            [Some(9.0), Some(1.0)],
            [Some(0.0), None],
            [Some(f64::NAN), Some(0.0)],
            [Some(f64::NEG_INFINITY), Some(f64::INFINITY)],
        ];
        assert_eq!(pareto_front(&points), [true, true, false, true, true, false, false, true]);
        assert_eq!(pareto_front(&[]), [false; 0]);
        let zeros = [[Some(0.0), Some(-0.0)], [Some(-0.0), Some(0.0)], [Some(0.0), Some(1.0)]];
        assert_eq!(pareto_front(&zeros), [true, true, false]);
    }

    /// Computes the front by its definition, pair by pair.
    fn naive(points: &[[Option<f64>; 2]]) -> Vec<bool> {
        let beats = |one: &[Option<f64>; 2], other: &[Option<f64>; 2]| {
            let mut better = false;
            for (one, other) in one.iter().zip(other) {
                let (Some(one), Some(other)) = (one, other) else { return false };
                if one > other {
                    return false;
                }
                better |= one < other;
            }
            better
        };
        let known = |point: &[Option<f64>; 2]| point.iter().all(Option::is_some);
        let on = |point| known(point) && !points.iter().any(|other| beats(other, point));
        points.iter().map(on).collect()
    }

    #[test]
    fn the_sweep_is_the_definition() {
        for seed in 0..3000 {
            let mut chance = fastrand::Rng::with_seed(seed);
            let (count, values) = (chance.usize(0..40), chance.i32(1..30));
            let mut cost = || {
                let value = f64::from(chance.i32(-values..=values)) / 4.0;
                (chance.u8(..) > 8).then_some(value)
            };
            let points: Vec<_> = (0..count).map(|_| [cost(), cost()]).collect();
            assert_eq!(pareto_front(&points), naive(&points), "seed {seed}: {points:?}");
        }
    }
}
