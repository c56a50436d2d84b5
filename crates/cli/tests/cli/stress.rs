// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of `stress`, end to end.

use crate::common::run_successfully;
use foveate_tools::testing::takes_whole_lists;
use serde_json::Value;

#[test]
fn the_short_form_prints_a_row_for_every_case() {
    let dir = tempfile::tempdir().unwrap();
    let json: Value =
        serde_json::from_str(&run_successfully(dir.path(), &["stress", "--short", "--json"]))
            .unwrap();
    assert_eq!(json["holds"], true);
    let rows = json["rows"].as_array().unwrap();
    for case in ["largest score reached", "variance, single-pass f32 (not used)", "flicker"] {
        assert!(rows.iter().any(|row| row["case"] == case), "{case}");
    }
    if takes_whole_lists() {
        let text = run_successfully(dir.path(), &["stress", "--short"]);
        assert!(text.ends_with(&format!("{0} of {0} cases hold\n", rows.len())), "{text}");
    }
}
