// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every row of a short run has the expected result.

use foveate_measure::stress::{RunDepth, run_cases};

#[test]
fn every_hard_case_holds() {
    let rows = run_cases(RunDepth::Short, &|_, _| {}, &|| false);
    assert!(rows.len() > 50, "{} rows", rows.len());
    let broken: Vec<_> = rows.iter().filter(|row| !row.is_as_expected).collect();
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn what_is_cancelled_ends_without_rows() {
    assert!(run_cases(RunDepth::Full, &|_, _| {}, &|| true).is_empty());
}
