// SPDX-License-Identifier: MIT OR Apache-2.0
//! All that one check of a design came to: its runs, and what of the Verilog none of them reached.

use crate::hierarchy::NotSimulated;
use crate::report::CosimReport;
use serde::{Deserialize, Serialize};

/// Version of [`Summary`] as JSON; changes when a field changes its meaning or goes.
pub const FORMAT_VERSION: u32 = 2;

/// The co-simulations of one design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// [`FORMAT_VERSION`].
    pub format_version: u32,
    /// [`Summary::verdict`] is that all is well.
    pub passed: bool,
    /// Fingerprint of the design, as in the README of its core.
    pub design: String,
    /// What was run, in this order; the last one may have a mismatch.
    pub runs: Vec<CosimReport>,
    /// Names of runs that the mismatch of an earlier one has left out.
    pub not_run: Vec<String>,
    /// Of Verilog that was given: modules that no run has reached, by file. Runs that a mismatch has
    /// left out count as if they had been made.
    pub not_simulated: Vec<NotSimulated>,
    /// Whether all of it had to be simulated; not where a level was asked for.
    pub whole: bool,
}

/// What a summary says in the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Everything that had to be simulated was, and agrees.
    Passed,
    /// A run has a mismatch, or compared nothing.
    Mismatch,
    /// What was simulated agrees; modules that had to be simulated were not.
    Incomplete,
}

impl Summary {
    /// The summary of runs of the design of this fingerprint.
    #[must_use]
    pub fn new(
        design: String,
        runs: Vec<CosimReport>,
        not_run: Vec<String>,
        not_simulated: Vec<NotSimulated>,
        whole: bool,
    ) -> Self {
        let format_version = FORMAT_VERSION;
        let passed = false;
        let mut summary =
            Self { format_version, passed, design, runs, not_run, not_simulated, whole };
        summary.passed = summary.verdict() == Verdict::Passed;
        summary
    }

    /// What it all comes to. Without a run nothing has passed.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        if self.runs.is_empty() || !self.runs.iter().all(CosimReport::passed) {
            Verdict::Mismatch
        } else if self.whole && !self.not_simulated.is_empty() {
            Verdict::Incomplete
        } else {
            Verdict::Passed
        }
    }

    /// Every file with modules that were not simulated, in one line.
    #[must_use]
    pub fn left_out(&self) -> String {
        self.not_simulated.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
    }
}
