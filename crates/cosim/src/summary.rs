// SPDX-License-Identifier: MIT OR Apache-2.0
//! The result of one check of a design: its runs, and the Verilog that no run reached, parameter values included.

use crate::elaboration::NotElaborated;
use crate::hierarchy::NotSimulated;
use crate::report::CosimReport;
use crate::situations::Occurrences;
use serde::{Deserialize, Serialize};

/// Version of [`Summary`] as JSON; changes when a field changes its meaning or goes.
pub const FORMAT_VERSION: u32 = 2;

/// The co-simulations of one design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// [`FORMAT_VERSION`].
    pub format_version: u32,
    /// Whether [`Summary::verdict`] is [`Verdict::Passed`].
    pub passed: bool,
    /// Fingerprint of the design, as in the README of its core.
    pub design: String,
    /// The runs in order; the last one may have a mismatch.
    pub runs: Vec<CosimReport>,
    /// Names of runs that were not started, because an earlier one had a mismatch.
    pub not_run: Vec<String>,
    /// For Verilog that was given: modules that no run has reached, by file. Runs that were not started
    /// because of a mismatch count as if they had run.
    pub not_simulated: Vec<NotSimulated>,
    /// For Verilog that was given: modules with parameter values that the design has and no run has elaborated.
    #[serde(default)]
    pub not_elaborated: Vec<NotElaborated>,
    /// How often each situation occurred that the design can have, in all runs together.
    #[serde(default)]
    pub situations: Occurrences,
    /// Whether all of the Verilog had to be simulated. It is false if the user chose a level.
    pub whole: bool,
}

/// Verilog that no run has reached.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Left {
    /// Modules that no run has reached, by file.
    pub modules: Vec<NotSimulated>,
    /// Modules with parameter values that no run has elaborated.
    pub variants: Vec<NotElaborated>,
}

/// The verdict of a summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Everything that had to be simulated was simulated, without a mismatch.
    Passed,
    /// A run has a mismatch, or compared nothing.
    Mismatch,
    /// There is no mismatch, but some modules that had to be simulated were not, or a situation did not occur that the design
    /// can have.
    Incomplete,
}

impl Summary {
    /// The summary of runs of the design of this fingerprint.
    #[must_use]
    pub fn new(
        design: String,
        runs: Vec<CosimReport>,
        not_run: Vec<String>,
        left: Left,
        whole: bool,
    ) -> Self {
        let Left { modules: not_simulated, variants: not_elaborated } = left;
        let format_version = FORMAT_VERSION;
        let passed = false;
        let situations = Occurrences::of_all(runs.iter().map(|run| &run.situations));
        let mut summary = Self {
            situations,
            format_version,
            passed,
            design,
            runs,
            not_run,
            not_simulated,
            not_elaborated,
            whole,
        };
        summary.passed = summary.verdict() == Verdict::Passed;
        summary
    }

    /// The verdict over all runs. Without a run nothing has passed.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        if self.runs.is_empty() || !self.runs.iter().all(CosimReport::passed) {
            Verdict::Mismatch
        } else if self.is_incomplete() {
            Verdict::Incomplete
        } else {
            Verdict::Passed
        }
    }

    /// Whether something that had to be simulated was not, or did not occur.
    fn is_incomplete(&self) -> bool {
        let has_left = !(self.not_simulated.is_empty() && self.not_elaborated.is_empty());
        !self.situations.missing().is_empty() || (self.whole && has_left)
    }

    /// Every file with modules that were not simulated, and every module with parameter values that were not
    /// elaborated, in one line.
    #[must_use]
    pub fn left_out(&self) -> String {
        let files = self.not_simulated.iter().map(ToString::to_string);
        let variants = self.not_elaborated.iter().map(ToString::to_string);
        files.chain(variants).collect::<Vec<_>>().join("; ")
    }
}
