// SPDX-License-Identifier: MIT OR Apache-2.0
//! The objectives that points are compared by, and the direction in which each figure is better.
//! Tables, plots and the page take both from here.

use crate::front::pareto_front;
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
    /// The LUTs of the array, including those used as memory.
    Luts,
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
            Self::Error | Self::Luts | Self::Mm2 | Self::Energy | Self::Stale | Self::Bytes => {
                BetterDirection::Smaller
            }
            Self::Speed | Self::PerClock | Self::Ssim => BetterDirection::Larger,
        }
    }

    /// Returns the figure of a point; `None` if it is not known.
    pub(crate) fn value_of(self, row: &DesignRow) -> Option<f64> {
        match self {
            Self::Error => Some(row.figures.action_flips),
            Self::Speed => row.speed.map(|speed| speed.frames_per_second),
            Self::PerClock => Some(1.0 / count_to_f64(row.clocks_per_frame)),
            Self::Luts => row.luts(),
            Self::Mm2 => row.process.as_ref().and_then(|process| process.mm2),
            Self::Energy => row.energy().map(|energy| energy.nj_per_region),
            Self::Stale => Some(row.figures.staleness.share),
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
    /// The area: square millimetres with a process, LUTs without one.
    pub(crate) area: Objective,
    /// True if some point has an area.
    pub(crate) has_areas: bool,
}

impl FrontObjectives {
    /// Returns the objectives of some points. `has_process` is true if they were to be mapped to the cells of a
    /// process.
    pub(crate) fn of_rows(rows: &[DesignRow], has_process: bool) -> Self {
        let has_clocks = rows.iter().any(|row| row.speed.is_some());
        let area = if has_process { Objective::Mm2 } else { Objective::Luts };
        Self {
            speed: if has_clocks { Objective::Speed } else { Objective::PerClock },
            area,
            has_areas: rows.iter().any(|row| area.value_of(row).is_some()),
        }
    }
}

/// Returns whether each point is unbeaten: no other point is as good in all objectives and better
/// in one.
pub(crate) fn unbeaten_rows<const N: usize>(
    rows: &[&DesignRow],
    objectives: [Objective; N],
) -> Vec<bool> {
    let costs = |row: &&DesignRow| objectives.map(|objective| objective.cost_of(row));
    pareto_front(&rows.iter().map(costs).collect::<Vec<_>>())
}

/// Marks the fronts of an exploration. `has_process` is true if its points were to be mapped to the cells of a
/// process.
pub(crate) fn mark_fronts(rows: &mut [DesignRow], has_process: bool) {
    use Objective::{Energy, Error};
    let FrontObjectives { speed: fast, area: small, has_areas } =
        FrontObjectives::of_rows(rows, has_process);
    let all: Vec<&DesignRow> = rows.iter().collect();
    let speed = unbeaten_rows(&all, [Error, fast]);
    let area = unbeaten_rows(&all, [Error, small]);
    let energy = unbeaten_rows(&all, [Error, Energy]);
    let both = if has_areas { unbeaten_rows(&all, [Error, fast, small]) } else { speed.clone() };
    for (index, row) in rows.iter_mut().enumerate() {
        row.front = FrontMembership {
            speed: speed[index],
            area: area[index],
            energy: energy[index],
            all: both[index],
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::sample_exploration;
    use crate::{ProcessEnergy, ProcessFigures};
    use foveate_estimate::FrameRate;

    /// Makes points with figures from a few values, so that many are equal. Some points have no
    /// area, and some no clock.
    fn points(seed: u64) -> Vec<DesignRow> {
        let row = sample_exploration("", true).rows.remove(0);
        let mut chance = fastrand::Rng::with_seed(seed);
        let mut point = || {
            let mut row = row.clone();
            row.figures.action_flips = f64::from(chance.u32(0..6)) / 10.0;
            row.clocks_per_frame = chance.u64(1..12);
            let mhz = f64::from(chance.u32(1..4));
            row.speed =
                (chance.u8(0..5) > 0).then(|| FrameRate::at_given_clock(mhz, row.clocks_per_frame));
            match &mut row.silicon {
                Some(silicon) if chance.u8(0..5) > 0 => {
                    silicon.array.lut_total_packed = chance.u64(1..12);
                }
                silicon => *silicon = None,
            }
            row
        };
        (0..60).map(|_| point()).collect()
    }

    /// The definition of the fronts by the figures of the table: lower error, more frames per
    /// second, fewer LUTs.
    fn beats(one: &DesignRow, other: &DesignRow, fast: bool, luts: bool) -> bool {
        let lut =
            |row: &DesignRow| row.silicon.as_ref().map(|silicon| silicon.array.lut_total_packed);
        let mut pairs = vec![one.figures.action_flips.total_cmp(&other.figures.action_flips)];
        if fast {
            let (Some(one), Some(other)) = (one.speed, other.speed) else { return false };
            pairs.push(other.frames_per_second.total_cmp(&one.frames_per_second));
        }
        if luts {
            let (Some(one), Some(other)) = (lut(one), lut(other)) else { return false };
            pairs.push(one.cmp(&other));
        }
        pairs.iter().all(|order| order.is_le()) && pairs.iter().any(|order| order.is_lt())
    }

    #[test]
    fn every_front_is_that_of_its_own_figures() {
        let (mut told_apart, mut without_area) = (0, 0);
        for seed in 0..200 {
            let mut rows = points(seed);
            mark_fronts(&mut rows, false);
            for row in &rows {
                let on = |fast: bool, luts: bool| {
                    let known = (!luts || row.silicon.is_some()) && (!fast || row.speed.is_some());
                    known && !rows.iter().any(|other| beats(other, row, fast, luts))
                };
                let expected = FrontMembership {
                    speed: on(true, false),
                    area: on(false, true),
                    energy: false,
                    all: on(true, true),
                };
                assert_eq!(row.front, expected, "seed {seed}, {row:?}");
                told_apart += usize::from(row.front.speed != row.front.area);
                without_area += usize::from(row.silicon.is_none() && row.front.speed);
            }
        }
        // Without many such points the test would not notice if speed and area were swapped.
        assert!(told_apart > 500 && without_area > 0, "{told_apart}, {without_area}");
    }

    /// The definition of a front by costs: all are known, and no other point has costs of which none is higher
    /// and one is lower.
    fn unbeaten(rows: &[DesignRow], costs: &dyn Fn(&DesignRow) -> Vec<Option<f64>>) -> Vec<bool> {
        let known = |row| costs(row).into_iter().collect::<Option<Vec<f64>>>();
        let all: Vec<_> = rows.iter().map(known).collect();
        let beats = |one: &Vec<f64>, other: &Vec<f64>| {
            one != other && one.iter().zip(other).all(|(one, other)| one <= other)
        };
        let is_beaten = |own| all.iter().flatten().any(|one| beats(one, own));
        all.iter().map(|own| own.as_ref().is_some_and(|own| !is_beaten(own))).collect()
    }

    #[test]
    fn in_a_process_the_fronts_are_those_of_its_area_and_energy() {
        let (mut differing, mut unknown) = (0, 0);
        for seed in 0..100 {
            let mut rows = points(seed);
            let mut chance = fastrand::Rng::with_seed(seed);
            for row in &mut rows {
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
            }
            mark_fronts(&mut rows, true);
            let error = |row: &DesignRow| Some(row.figures.action_flips);
            let pace = |row: &DesignRow| row.speed.map(|speed| -speed.frames_per_second);
            let mm2 = |row: &DesignRow| row.process.as_ref()?.mm2;
            let energy = |row: &DesignRow| Some(row.process.as_ref()?.energy?.nj_per_region);
            let front = |costs: &dyn Fn(&DesignRow) -> Vec<Option<f64>>| unbeaten(&rows, costs);
            let area = front(&|row| vec![error(row), mm2(row)]);
            let least = front(&|row| vec![error(row), energy(row)]);
            let all = front(&|row| vec![error(row), pace(row), mm2(row)]);
            for (index, row) in rows.iter().enumerate() {
                let found = [row.front.area, row.front.energy, row.front.all];
                assert_eq!(found, [area[index], least[index], all[index]], "seed {seed}: {row:?}");
                differing += usize::from(row.front.area != row.front.energy);
                unknown += usize::from(mm2(row).is_none());
            }
        }
        assert!(differing > 100 && unknown > 100, "{differing}, {unknown}");
    }

    #[test]
    fn without_clocks_fewer_clocks_per_frame_are_faster() {
        let mut rows = points(1);
        rows.iter_mut().for_each(|row| row.speed = None);
        mark_fronts(&mut rows, false);
        let beaten = |row: &DesignRow| {
            rows.iter().any(|other| {
                let error = other.figures.action_flips.total_cmp(&row.figures.action_flips);
                let both = [error, other.clocks_per_frame.cmp(&row.clocks_per_frame)];
                both.iter().all(|order| order.is_le()) && both.iter().any(|order| order.is_lt())
            })
        };
        assert!(rows.iter().all(|row| row.front.speed != beaten(row)));
    }

    #[test]
    fn without_areas_the_front_is_that_of_speed() {
        let mut rows = points(1);
        rows.iter_mut().for_each(|row| row.silicon = None);
        mark_fronts(&mut rows, false);
        assert!(rows.iter().any(|row| row.front.speed));
        assert!(rows.iter().all(|row| row.front.all == row.front.speed && !row.front.area));
    }
}
