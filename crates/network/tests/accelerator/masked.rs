// SPDX-License-Identifier: MIT OR Apache-2.0
//! The data in the documentation show the savings of masks.

#[path = "../../examples/masked/table.rs"]
mod table;

#[test]
fn the_data_in_the_documentation_are_those_of_the_table() {
    let data = include_str!("../../../../docs/data/accelerators-masked.csv");
    let table = table::shares_table().unwrap();
    let cells = |row: &str| row.trim_matches(['|', ' ']).replace(" | ", ",");
    let heading =
        |row: &str| cells(row).to_lowercase().replace(", %", "_percent").replace(' ', "_");
    let mut rows = table.lines();
    let mut expected = vec![heading(rows.next().unwrap())];
    expected.extend(rows.skip(1).map(cells));
    let held: Vec<&str> = data.lines().collect();
    assert_eq!(
        held, expected,
        "docs/data/accelerators-masked.csv should hold this table:\n{table}"
    );
}
