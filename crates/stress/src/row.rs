// SPDX-License-Identifier: MIT OR Apache-2.0
//! A line of the table.

use serde::Serialize;

/// One case on one design, or on a matrix of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CaseRow {
    /// What is tried.
    pub case: &'static str,
    /// On which designs.
    pub designs: String,
    /// What must come out.
    pub expected: String,
    /// What came out.
    pub observed: String,
    /// The worst error, in the unit of what is expected.
    pub worst: String,
    /// Whether the observation is as expected.
    pub holds: bool,
}

impl CaseRow {
    /// A case in which two numbers must be equal.
    pub(crate) fn equal(
        case: &'static str,
        designs: impl Into<String>,
        want: u64,
        got: u64,
    ) -> Self {
        Self {
            case,
            designs: designs.into(),
            expected: want.to_string(),
            observed: got.to_string(),
            worst: want.abs_diff(got).to_string(),
            holds: want == got,
        }
    }

    /// A case in which nothing may go wrong, `wrong` times of `tried`; `worst` is the largest error.
    pub(crate) fn none(
        case: &'static str,
        designs: impl Into<String>,
        what: &str,
        (wrong, tried): (u64, u64),
        worst: impl Into<u64>,
    ) -> Self {
        Self {
            case,
            designs: designs.into(),
            expected: format!("0 {what}"),
            observed: format!("{wrong} of {tried}"),
            worst: worst.into().to_string(),
            // A case that has tried nothing has shown nothing.
            holds: wrong == 0 && tried > 0,
        }
    }
}
