// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pages of configuration and contract name the features with the defaults and units of their
//! descriptions.

use foveate_camera::{FeatureKind, ScoreUnit};

const CONFIGURATION: &str = include_str!("../../../../docs/configuration.md");
const CONTRACT: &str = include_str!("../../../../docs/contract.md");

/// Returns the default and the meaning of a key, from its row of the page.
fn row_of_key(key: &str) -> (&'static str, &'static str) {
    let start = format!("| `{key}` |");
    let row =
        CONFIGURATION.lines().find(|line| line.starts_with(&start)).expect("a row of the key");
    let cells: Vec<_> = row.split(" | ").collect();
    (cells[1], cells[2])
}

/// Returns the default of a feature in a cell such as `5; `variance`: 50`.
fn default_in(cell: &str, kind: FeatureKind) -> Option<u64> {
    let named =
        cell.split([';', ',']).find_map(|part| part.trim().strip_prefix(&format!("`{kind}`: ")));
    let common = || cell.split(';').next().filter(|part| !part.contains('`'));
    named.or_else(common).and_then(|value| value.trim().parse().ok())
}

#[test]
fn defaults_are_those_of_the_page() {
    let (levels, (minima, _)) = (row_of_key("spatial.level").0, row_of_key("spatial.min_score"));
    for &kind in FeatureKind::ALL {
        let spec = kind.spec();
        let level = spec.level.as_ref().map(|level| u64::from(level.default));
        assert_eq!(default_in(levels, kind), level, "{kind}");
        assert_eq!(default_in(minima, kind), Some(spec.min_score), "{kind}");
    }
}

#[test]
fn units_are_those_of_the_page() {
    let (_, meaning) = row_of_key("spatial.min_score");
    let units = [
        (ScoreUnit::Pixels, ": pixels for "),
        (ScoreUnit::Levels, "grey levels for "),
        (ScoreUnit::SquaredLevels, "squared grey levels for "),
    ];
    for (unit, words) in units {
        let (_, names) = meaning.split_once(words).expect("the unit is named");
        let named: Vec<_> = names.split('`').skip(1).step_by(2).collect();
        let kinds = FeatureKind::ALL.iter().filter(|kind| kind.score_unit() == unit);
        let kinds: Vec<_> = kinds.map(|kind| kind.name()).collect();
        assert_eq!(&named[..kinds.len()], kinds, "{}", unit.name());
    }
}

#[test]
fn the_contract_has_a_row_for_each_feature() {
    for kind in FeatureKind::ALL {
        let start = format!("| `{kind}` |");
        let rows = CONTRACT.lines().filter(|line| line.starts_with(&start)).count();
        assert_eq!(rows, 1, "{kind}");
    }
}
