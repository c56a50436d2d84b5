// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pareto fronts: points that no other point beats.

/// Whether each point is on the front of its objectives, all of which are to be small: no other point
/// is as good in all and better in one. A point without a figure is on none.
pub(crate) fn front<const N: usize>(points: &[[Option<f64>; N]]) -> Vec<bool> {
    let known = |point: &[Option<f64>; N]| -> Option<[f64; N]> {
        let values = point.map(|value| value.unwrap_or(f64::NAN));
        values.iter().all(|value| !value.is_nan()).then_some(values)
    };
    let known: Vec<_> = points.iter().map(known).collect();
    let beaten = |point: &[f64; N]| known.iter().flatten().any(|other| beats(other, point));
    known.iter().map(|point| point.as_ref().is_some_and(|point| !beaten(point))).collect()
}

fn beats<const N: usize>(one: &[f64; N], other: &[f64; N]) -> bool {
    let mut pairs = one.iter().zip(other);
    pairs.clone().all(|(one, other)| one <= other) && pairs.any(|(one, other)| one < other)
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
        ];
        assert_eq!(front(&points), [true, true, false, true, true, false]);
        assert_eq!(front::<2>(&[]), [false; 0]);
    }
}
