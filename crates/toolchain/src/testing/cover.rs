// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of the designs that a slow test takes from a matrix of designs.
//!
//! A matrix has more designs than a slow tool can build in every run of the tests. Most faults
//! depend on one key of the configuration or on two, so [`cover`] takes few designs in which every
//! pair of values of the matrix still occurs, or, for the slowest tools, every value.

use std::collections::{BTreeMap, BTreeSet};

use super::takes_whole_lists;

/// The density with which a test covers a matrix of designs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoverDepth {
    /// Fewest designs, in which every value of a key that occurs in the matrix occurs.
    Values,
    /// Few designs, in which every pair of values of two keys that occurs in the matrix occurs.
    Pairs,
    /// All designs of the matrix.
    Whole,
}

impl CoverDepth {
    /// Returns the depth of this run of the tests: whole if the environment variable
    /// `FOVEATE_WHOLE` is set, and otherwise pairs.
    #[must_use]
    pub fn of_run() -> Self {
        Self::Pairs.unless_whole()
    }

    /// Returns the depth of this run of a test with a very slow tool: whole if the environment
    /// variable `FOVEATE_WHOLE` is set, and otherwise values.
    #[must_use]
    pub fn of_slow_run() -> Self {
        Self::Values.unless_whole()
    }

    fn unless_whole(self) -> Self {
        if takes_whole_lists() { Self::Whole } else { self }
    }
}

/// Returns the designs of a matrix that cover it, in their order. `toml` returns the configuration
/// of a design as `to_toml` writes it. A key that a design lacks counts as a value of its own.
/// The size of the frame and the thresholds are numbers without a case of their own in the
/// hardware, so they do not count.
///
/// The choice is greedy: it takes the design that adds most pairs or values, and of equal ones the
/// first.
pub fn cover<T>(designs: Vec<T>, depth: CoverDepth, toml: impl Fn(&T) -> String) -> Vec<T> {
    let values = || designs.iter().map(|design| key_values(&toml(design))).collect::<Vec<_>>();
    let items = match depth {
        CoverDepth::Values => value_pairs(&values(), |one, other| one == other),
        CoverDepth::Pairs => value_pairs(&values(), |_, _| true),
        CoverDepth::Whole => return designs,
    };
    let mut missing: BTreeSet<usize> = items.iter().flatten().copied().collect();
    let mut taken = BTreeSet::new();
    while !missing.is_empty() {
        let added = |&design: &usize| items[design].intersection(&missing).count();
        // `max_by_key` returns the last of equal ones, so the search goes backwards.
        let best = (0..designs.len()).rev().max_by_key(added);
        let best = best.expect("a missing item belongs to a design");
        missing.retain(|item| !items[best].contains(item));
        taken.insert(best);
    }
    let numbered = designs.into_iter().enumerate();
    numbered.filter_map(|(number, design)| taken.contains(&number).then_some(design)).collect()
}

/// The last parts of the names of the keys that do not count.
const UNCOUNTED: [&str; 5] = ["width", "height", "level", "min_count", "min_score"];

/// Returns the values of a configuration by their keys. The tables of an array make one value.
fn key_values(toml: &str) -> BTreeMap<String, String> {
    let (mut table, mut values) = ("", BTreeMap::<String, String>::new());
    for line in toml.lines() {
        if let Some(name) = line.strip_prefix('[') {
            table = name.trim_matches(['[', ']']);
        }
        let Some((key, value)) = line.split_once(" = ") else { continue };
        if !UNCOUNTED.contains(&key) {
            values.entry(format!("{table}.{key}")).or_default().push_str(value);
        }
    }
    values
}

/// Returns the pairs of values of every design, of the keys whose places `counts` accepts. Each pair
/// has a number. A value makes a pair with itself, too.
fn value_pairs(
    designs: &[BTreeMap<String, String>],
    counts: impl Fn(usize, usize) -> bool,
) -> Vec<BTreeSet<usize>> {
    let keys: BTreeSet<&String> = designs.iter().flat_map(BTreeMap::keys).collect();
    let mut numbers = BTreeMap::new();
    let mut pairs_of = |values: &BTreeMap<String, String>| {
        let values: Vec<_> = keys.iter().map(|&key| (key, values.get(key).cloned())).collect();
        let all =
            (0..values.len()).flat_map(|one| (one..values.len()).map(move |other| (one, other)));
        let counted = all.filter(|&(one, other)| counts(one, other));
        let pairs = counted.map(|(one, other)| (values[one].clone(), values[other].clone()));
        pairs
            .map(|pair| {
                let next = numbers.len();
                *numbers.entry(pair).or_insert(next)
            })
            .collect()
    };
    designs.iter().map(&mut pairs_of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    type MatrixDesign = (u32, u32, Option<u32>);

    /// Returns the 36 designs of three, four and three values. The third key may be absent.
    fn matrix() -> Vec<MatrixDesign> {
        let pairs = (0..12).map(|number| (number / 4, number % 4));
        pairs.flat_map(|(a, b)| [None, Some(0), Some(1)].map(|c| (a, b, c))).collect()
    }

    fn toml(&(first, second, third): &MatrixDesign) -> String {
        let third = third.map_or(String::new(), |third| format!("third = {third}\n"));
        format!(
            "[frame]\nwidth = {second}{first}\n[one]\nfirst = {first}\n[two]\nsecond = {second}\n{third}"
        )
    }

    #[test]
    fn few_designs_have_every_pair() {
        let few = cover(matrix(), CoverDepth::Pairs, toml);
        assert!((12..=15).contains(&few.len()), "{few:?}");
        let count = |pair: fn(&MatrixDesign) -> (u32, Option<u32>)| {
            few.iter().map(pair).collect::<BTreeSet<_>>().len()
        };
        let pairs = [
            count(|&(first, second, _)| (first, Some(second))),
            count(|&(first, _, third)| (first, third)),
            count(|&(_, second, third)| (second, third)),
        ];
        assert_eq!(pairs, [12, 9, 12]);
    }

    #[test]
    fn fewer_designs_have_every_value() {
        let fewest = cover(matrix(), CoverDepth::Values, toml);
        let count = |value: fn(&MatrixDesign) -> u32| {
            fewest.iter().map(value).collect::<BTreeSet<_>>().len()
        };
        assert_eq!([count(|design| design.0), count(|design| design.1)], [3, 4]);
        assert_eq!(count(|design| design.2.map_or(9, |third| third)), 3);
        assert!((4..=5).contains(&fewest.len()), "{fewest:?}");
    }

    #[test]
    fn the_choice_is_in_order_and_always_the_same() {
        let few = cover(matrix(), CoverDepth::Pairs, toml);
        assert!(few.is_sorted());
        assert_eq!(few, cover(matrix(), CoverDepth::Pairs, toml));
    }

    #[test]
    fn a_design_with_a_value_of_its_own_is_always_taken() {
        let own: Vec<_> = (0..5).map(|number| (number, 0, None)).collect();
        assert_eq!(cover(own.clone(), CoverDepth::Pairs, toml), own);
        assert!(cover(Vec::new(), CoverDepth::Pairs, toml).is_empty());
    }

    #[test]
    fn the_whole_matrix_is_taken_at_the_depth_whole() {
        assert_eq!(cover(matrix(), CoverDepth::Whole, toml), matrix());
    }

    #[test]
    fn a_list_of_tables_is_one_value() {
        let toml =
            "a = 1\n[[spatial]]\nfeature = \"edge\"\nlevel = 3\n\n[[spatial]]\nfeature = \"mad\"\n";
        let wanted = [(".a", "1"), ("spatial.feature", "\"edge\"\"mad\"")];
        let wanted = wanted.map(|(key, value)| (key.to_owned(), value.to_owned()));
        assert_eq!(key_values(toml), BTreeMap::from(wanted));
    }
}
