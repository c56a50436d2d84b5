// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of the combinations of axis values that become points.

use std::collections::BTreeSet;

use toml::Value;

/// The most points of a space.
pub(crate) const MAX_POINTS: usize = 100_000;

/// A key of the configuration and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceAxis {
    /// The dotted key, for example `region.size` or `spatial.0.level`.
    pub key: String,
    /// The values, as in the file.
    pub values: Vec<Value>,
}

/// The method that chooses the points of a space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SamplingMethod {
    /// Every combination.
    Grid,
    /// The start, and every value of each axis alone. This shows the cost of each single choice.
    OneAtATime,
    /// A number of combinations that are drawn without repetition.
    Sample {
        /// The number of combinations; all of them if there are fewer.
        points: usize,
        /// The seed of the choice.
        seed: u64,
    },
}

impl SamplingMethod {
    pub(crate) fn parse(
        name: Option<&str>,
        points: Option<usize>,
        seed: Option<u64>,
    ) -> Result<Self, String> {
        let own = match name.unwrap_or("grid") {
            "grid" => Self::Grid,
            "each" => Self::OneAtATime,
            "sample" => {
                let points = points.filter(|points| (1..=MAX_POINTS).contains(points));
                let points = points.ok_or_else(|| {
                    format!("method = \"sample\" needs points, 1 to {MAX_POINTS}")
                })?;
                return Ok(Self::Sample { points, seed: seed.unwrap_or(1) });
            }
            other => {
                return Err(format!(
                    "method = \"{other}\" is unknown; use \"grid\", \"each\" or \"sample\""
                ));
            }
        };
        match points.map(|_| "points").or(seed.map(|_| "seed")) {
            Some(key) => Err(format!("{key} is only for method = \"sample\"")),
            None => Ok(own),
        }
    }

    /// Returns the number of combinations to try; `None` if it exceeds the range of `usize`.
    pub(crate) fn count(self, axes: &[SpaceAxis]) -> Option<usize> {
        let all = axes.iter().try_fold(1_usize, |all, axis| all.checked_mul(axis.values.len()));
        match self {
            Self::Grid => all,
            Self::OneAtATime => Some(1 + axes.iter().map(|axis| axis.values.len()).sum::<usize>()),
            Self::Sample { points, .. } => all.map(|all| all.min(points)),
        }
    }

    /// Returns the combinations: for each axis the index of its value, or `None` for the value of
    /// the start.
    pub(crate) fn combinations(self, axes: &[SpaceAxis]) -> Vec<Vec<Option<usize>>> {
        let all: usize = axes.iter().map(|axis| axis.values.len()).product();
        let mixed = |mut number: usize| {
            // The last axis changes fastest, as in nested loops.
            let digit = |axis: &SpaceAxis| {
                let digit = number % axis.values.len();
                number /= axis.values.len();
                Some(digit)
            };
            let mut digits: Vec<_> = axes.iter().rev().map(digit).collect();
            digits.reverse();
            digits
        };
        match self {
            Self::Grid => (0..all).map(mixed).collect(),
            Self::Sample { points, seed } => {
                sample_numbers(all, points, seed).into_iter().map(mixed).collect()
            }
            Self::OneAtATime => {
                let start = vec![None; axes.len()];
                let alone = axes.iter().enumerate().flat_map(|(place, axis)| {
                    let start = &start;
                    (0..axis.values.len()).map(move |value| {
                        let mut one = start.clone();
                        one[place] = Some(value);
                        one
                    })
                });
                std::iter::once(start.clone()).chain(alone).collect()
            }
        }
    }
}

/// Returns `points` different numbers below `all`, in rising order.
fn sample_numbers(all: usize, points: usize, seed: u64) -> BTreeSet<usize> {
    if points >= all {
        return (0..all).collect();
    }
    let mut chance = fastrand::Rng::with_seed(seed);
    // Floyd's algorithm needs as many draws as numbers.
    let mut drawn = BTreeSet::new();
    for last in all - points..all {
        let number = chance.usize(0..=last);
        if !drawn.insert(number) {
            drawn.insert(last);
        }
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(sizes: &[usize]) -> Vec<SpaceAxis> {
        let axis = |&size: &usize| SpaceAxis {
            key: "key".to_owned(),
            values: (0..i64::try_from(size).unwrap()).map(Value::Integer).collect(),
        };
        sizes.iter().map(axis).collect()
    }

    #[test]
    fn a_grid_is_every_combination_once() {
        let found = SamplingMethod::Grid.combinations(&axes(&[2, 3]));
        let expected: Vec<Vec<_>> =
            (0..2).flat_map(|a| (0..3).map(move |b| vec![Some(a), Some(b)])).collect();
        assert_eq!(found, expected);
        assert_eq!(SamplingMethod::Grid.combinations(&[]), [vec![]]);
        assert_eq!(SamplingMethod::Grid.count(&axes(&[100; 10])), None);
    }

    #[test]
    fn each_value_stands_alone() {
        let found = SamplingMethod::OneAtATime.combinations(&axes(&[1, 2]));
        let expected =
            [vec![None, None], vec![Some(0), None], vec![None, Some(0)], vec![None, Some(1)]];
        assert_eq!(found, expected);
        assert_eq!(SamplingMethod::OneAtATime.count(&axes(&[1, 2])), Some(4));
    }

    #[test]
    fn a_sample_has_as_many_as_asked_and_its_seed_decides_which() {
        let of = |points, seed| {
            SamplingMethod::Sample { points, seed }.combinations(&axes(&[10, 10, 10]))
        };
        let found = of(50, 1);
        let different: BTreeSet<_> = found.iter().collect();
        assert_eq!((found.len(), different.len()), (50, 50));
        assert_eq!((of(50, 1) == found, of(50, 2) == found), (true, false));
        assert_eq!(of(5_000, 1), SamplingMethod::Grid.combinations(&axes(&[10, 10, 10])));
    }
}
