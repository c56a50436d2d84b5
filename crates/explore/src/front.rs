// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pareto fronts of two costs: the points that no other point beats.

/// Returns whether each point is on the front of its two costs: no other point has costs that are both
/// at most as high and one of them lower. A point without a cost, or with NaN as a cost, is on no
/// front and beats no point.
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
