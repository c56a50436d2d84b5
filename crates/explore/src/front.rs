// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pareto fronts: the points that no other point beats, in O(n log n) for up to three costs.

use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Returns whether each point is on the front of its costs: no other point has costs that are all
/// at most as high and one of them lower. A point without a cost, or with NaN as a cost, is on no
/// front and beats no point.
pub(crate) fn pareto_front<const N: usize>(points: &[[Option<f64>; N]]) -> Vec<bool> {
    const { assert!(1 <= N && N <= 3, "the sweep is for one to three costs") };
    let known = |(index, point): (usize, &[Option<f64>; N])| {
        let mut costs = [FrontCost(0.0); 3];
        for (cost, value) in costs.iter_mut().zip(point) {
            // Adding zero turns -0 into 0.
            *cost = FrontCost(value.filter(|value| !value.is_nan())? + 0.0);
        }
        Some((costs, index))
    };
    let mut known: Vec<([FrontCost; 3], usize)> =
        points.iter().enumerate().filter_map(known).collect();
    known.sort_unstable();
    let mut on_front = vec![false; points.len()];
    let mut stairs = UnbeatenPairs::default();
    // A point that beats another one comes before it; equal points do not beat each other.
    for equal in known.chunk_by(|one, other| one.0 == other.0) {
        let [_, second, third] = equal[0].0;
        if stairs.add(second, third) {
            equal.iter().for_each(|(_, index)| on_front[*index] = true);
        }
    }
    on_front
}

/// The unbeaten pairs of costs so far, sorted by the first cost: the second cost falls as the first
/// one rises.
#[derive(Default)]
struct UnbeatenPairs(BTreeMap<FrontCost, FrontCost>);

impl UnbeatenPairs {
    /// Adds a pair, unless a known pair is at most as high in both costs. Returns whether it was
    /// added.
    fn add(&mut self, first: FrontCost, second: FrontCost) -> bool {
        if self.0.range(..=first).next_back().is_some_and(|(_, below)| *below <= second) {
            return false;
        }
        while let Some((&next, _)) =
            self.0.range(first..).next().filter(|(_, beaten)| **beaten >= second)
        {
            self.0.remove(&next);
        }
        self.0.insert(first, second);
        true
    }
}

/// A cost with a total order: never NaN, and with only one zero.
#[derive(Clone, Copy, Debug)]
struct FrontCost(f64);

impl PartialEq for FrontCost {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for FrontCost {}

impl PartialOrd for FrontCost {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for FrontCost {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(pareto_front::<2>(&[]), [false; 0]);
        assert_eq!(pareto_front(&[[Some(0.0)], [Some(-0.0)], [Some(1.0)]]), [true, true, false]);
    }

    /// Computes the front by its definition, pair by pair.
    fn naive<const N: usize>(points: &[[Option<f64>; N]]) -> Vec<bool> {
        let beats = |one: &[Option<f64>; N], other: &[Option<f64>; N]| {
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
        let known = |point: &[Option<f64>; N]| point.iter().all(Option::is_some);
        let on = |point| known(point) && !points.iter().any(|other| beats(other, point));
        points.iter().map(on).collect()
    }

    fn agree<const N: usize>(seed: u64) {
        let mut chance = fastrand::Rng::with_seed(seed);
        let (count, values) = (chance.usize(0..40), chance.i32(1..30));
        let mut cost = || {
            let value = f64::from(chance.i32(-values..=values)) / 4.0;
            (chance.u8(..) > 8).then_some(value)
        };
        let points: Vec<[Option<f64>; N]> =
            (0..count).map(|_| std::array::from_fn(|_| cost())).collect();
        assert_eq!(pareto_front(&points), naive(&points), "seed {seed}: {points:?}");
    }

    #[test]
    fn the_sweep_is_the_definition() {
        for seed in 0..3000 {
            agree::<1>(seed);
            agree::<2>(seed);
            agree::<3>(seed);
        }
    }

    #[test]
    fn many_points_take_no_time() {
        // All points are on the front, which is the worst case. Comparing every pair would take
        // 10^10 steps.
        let count = 100_000;
        let points: Vec<[Option<f64>; 3]> = (0..count)
            .map(|x| [Some(f64::from(x)), Some(f64::from(count - x)), Some(0.0)])
            .collect();
        assert!(pareto_front(&points).iter().all(|on| *on));
    }
}
