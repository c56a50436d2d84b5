// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of a case, a row of their table ([`CaseRow`]), and how long the case may take for
//! it ([`RunDepth`]).

use serde::Serialize;

/// The result of one case on one design, or on a matrix of designs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CaseRow {
    /// The name of the case.
    pub case: &'static str,
    /// The designs of the case.
    pub designs: String,
    /// The expected result.
    pub expected: String,
    /// The observed result.
    pub observed: String,
    /// The worst error, in the unit of the expected result.
    pub worst: String,
    /// The observed result is as expected.
    #[serde(rename = "holds")]
    pub is_as_expected: bool,
}

impl CaseRow {
    pub(crate) fn for_equal_numbers(
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
            is_as_expected: want == got,
        }
    }

    /// Makes the row of a case in which no error may occur. `wrong` of `tried` trials failed, and
    /// `worst` is the largest error.
    pub(crate) fn for_no_errors(
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
            // A case without trials proves nothing.
            is_as_expected: wrong == 0 && tried > 0,
        }
    }
}

/// The depth of a run, which decides how long it takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunDepth {
    /// A run of seconds, as the tests do it.
    Short,
    /// A run of minutes, with all cases that the documentation promises.
    Full,
}

impl RunDepth {
    /// Returns one of two values, depending on the depth.
    pub(crate) fn choose<T>(self, short: T, full: T) -> T {
        match self {
            Self::Short => short,
            Self::Full => full,
        }
    }
}
