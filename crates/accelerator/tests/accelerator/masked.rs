// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page shows what masks save.

#[path = "../../examples/masked/table.rs"]
mod table;

#[test]
fn the_page_shows_the_table() {
    let page = include_str!("../../../../docs/accelerators.md");
    let table = table::shares().unwrap();
    assert!(page.contains(&table), "docs/accelerators.md should hold this table:\n{table}");
}
