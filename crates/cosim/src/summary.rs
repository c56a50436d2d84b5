// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of one check of a design: its runs, and the Verilog and parameter values that no run
//! reached.

use crate::elaboration::UnelaboratedVariant;
use crate::hierarchy::UnsimulatedModules;
use crate::report::CosimReport;
use crate::situations::Occurrences;
use serde::{Deserialize, Serialize};

/// The version of [`CosimSummary`] as JSON; it changes when a field is removed or gets another
/// meaning.
pub const FORMAT_VERSION: u32 = 2;

/// The result of the co-simulations of one design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CosimSummary {
    /// The version of the format, which is [`FORMAT_VERSION`].
    pub format_version: u32,
    /// True if [`CosimSummary::verdict`] is [`CosimVerdict::Passed`].
    pub passed: bool,
    /// The fingerprint of the design, as in the README of its core.
    pub design: String,
    /// The runs in order; the last one may have a mismatch.
    pub runs: Vec<CosimReport>,
    /// The names of runs that were not started, because an earlier one had a mismatch.
    pub not_run: Vec<String>,
    /// The modules that no run has reached, by file, for Verilog that the user gave. Runs that were
    /// not started because of a mismatch count as if they had run.
    pub not_simulated: Vec<UnsimulatedModules>,
    /// The modules with parameter values that the design has and no run has elaborated, for Verilog
    /// that the user gave.
    #[serde(default)]
    pub not_elaborated: Vec<UnelaboratedVariant>,
    /// The number of times that each situation occurred that the design can have, over all runs.
    #[serde(default)]
    pub situations: Occurrences,
    /// True if all of the Verilog had to be simulated. It is false if the user chose a level.
    #[serde(rename = "whole")]
    pub must_be_whole: bool,
}

/// The Verilog that no run has reached.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnreachedVerilog {
    /// The modules that no run has reached, by file.
    pub modules: Vec<UnsimulatedModules>,
    /// The modules with parameter values that no run has elaborated.
    pub variants: Vec<UnelaboratedVariant>,
}

/// The verdict of a summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CosimVerdict {
    /// All that had to be simulated was simulated, without a mismatch.
    Passed,
    /// A run has a mismatch, or compared nothing.
    Mismatch,
    /// There is no mismatch, but some modules that had to be simulated were not, or a situation
    /// that the design can have did not occur.
    Incomplete,
}

impl CosimSummary {
    /// Creates the summary of runs of the design with this fingerprint.
    #[must_use]
    pub fn new(
        design: String,
        runs: Vec<CosimReport>,
        not_run: Vec<String>,
        left: UnreachedVerilog,
        whole: bool,
    ) -> Self {
        let UnreachedVerilog { modules: not_simulated, variants: not_elaborated } = left;
        let format_version = FORMAT_VERSION;
        let passed = false;
        let situations = Occurrences::sum_of(runs.iter().map(|run| &run.situations));
        let mut summary = Self {
            situations,
            format_version,
            passed,
            design,
            runs,
            not_run,
            not_simulated,
            not_elaborated,
            must_be_whole: whole,
        };
        summary.passed = summary.verdict() == CosimVerdict::Passed;
        summary
    }

    /// Returns the verdict over all runs. Without a run it is [`CosimVerdict::Mismatch`].
    #[must_use]
    pub fn verdict(&self) -> CosimVerdict {
        if self.runs.is_empty() || !self.runs.iter().all(CosimReport::passed) {
            CosimVerdict::Mismatch
        } else if self.is_incomplete() {
            CosimVerdict::Incomplete
        } else {
            CosimVerdict::Passed
        }
    }

    /// Returns true if something that had to be simulated was not, or a situation did not occur.
    fn is_incomplete(&self) -> bool {
        let has_left = !(self.not_simulated.is_empty() && self.not_elaborated.is_empty());
        !self.situations.missing().is_empty() || (self.must_be_whole && has_left)
    }

    /// Returns one line with every file with modules that were not simulated, and every module with
    /// parameter values that were not elaborated.
    #[must_use]
    pub fn describe_unreached(&self) -> String {
        let files = self.not_simulated.iter().map(ToString::to_string);
        let variants = self.not_elaborated.iter().map(ToString::to_string);
        files.chain(variants).collect::<Vec<_>>().join("; ")
    }
}
