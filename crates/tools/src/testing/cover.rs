// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of the designs that a slow test takes from a matrix of designs.
//!
//! A matrix has more designs than a tool can build in every run of the tests. Most faults depend on
//! one key of the configuration, so [`cover`] takes few designs in which every value of the matrix
//! still occurs.

use std::collections::{BTreeMap, BTreeSet};

use super::takes_whole_lists;

/// Returns the designs of a matrix that cover it, in their order: the fewest in which every value
/// of a key that occurs in the matrix occurs, or all of them if tests take whole lists. `toml`
/// returns the configuration of a design as `to_toml` writes it. A key that a design lacks counts
/// as a value of its own. The size of the frame and the thresholds are numbers without a case of
/// their own in the hardware, so they do not count.
pub fn cover<T>(designs: Vec<T>, toml: impl Fn(&T) -> String) -> Vec<T> {
    if takes_whole_lists() { designs } else { cover_of_values(designs, toml) }
}

/// The choice is greedy: it takes the design that adds most values, and of equal ones the first.
fn cover_of_values<T>(designs: Vec<T>, toml: impl Fn(&T) -> String) -> Vec<T> {
    let values: Vec<_> = designs.iter().map(|design| key_values(&toml(design))).collect();
    let keys: BTreeSet<&String> = values.iter().flat_map(BTreeMap::keys).collect();
    let items = values.iter().map(|values| keys.iter().map(|&key| (key, values.get(key))));
    let items: Vec<BTreeSet<_>> = items.map(Iterator::collect).collect();
    let mut missing: BTreeSet<_> = items.iter().flatten().copied().collect();
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
    fn few_designs_have_every_value() {
        let fewest = cover_of_values(matrix(), toml);
        let count = |value: fn(&MatrixDesign) -> u32| {
            fewest.iter().map(value).collect::<BTreeSet<_>>().len()
        };
        assert_eq!([count(|design| design.0), count(|design| design.1)], [3, 4]);
        assert_eq!(count(|design| design.2.map_or(9, |third| third)), 3);
        assert!((4..=5).contains(&fewest.len()), "{fewest:?}");
    }

    #[test]
    fn the_choice_is_in_order_and_always_the_same() {
        let few = cover_of_values(matrix(), toml);
        assert!(few.is_sorted());
        assert_eq!(few, cover_of_values(matrix(), toml));
    }

    #[test]
    fn a_design_with_a_value_of_its_own_is_always_taken() {
        let own: Vec<_> = (0..5).map(|number| (number, 0, None)).collect();
        assert_eq!(cover_of_values(own.clone(), toml), own);
        assert!(cover_of_values(Vec::new(), toml).is_empty());
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
