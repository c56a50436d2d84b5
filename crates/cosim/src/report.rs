// SPDX-License-Identifier: MIT OR Apache-2.0
//! The results of co-simulation, for people and for programs: of one run ([`CosimReport`]), of
//! all runs of a design with the Verilog and parameter values that none of them reached
//! ([`CosimSummary`]), and as JUnit XML, which test servers read ([`junit_xml`]).

use crate::elaboration::UnelaboratedVariant;
use crate::hierarchy::UnsimulatedModules;
use crate::level::CosimLevel;
use crate::mismatch::Mismatch;
use crate::netlist::NetlistRecord;
use crate::simulation::Simulator;
use crate::situations::Occurrences;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::PathBuf;
use std::time::Duration;

/// The result of one co-simulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CosimReport {
    /// The name of the run for people, such as `rpu verilator`.
    pub name: String,
    /// The fingerprint of the design, as in the README of its core. [`CosimReport::grid`] is the
    /// part of it that was simulated.
    pub design: String,
    /// The part of the hardware that was simulated.
    pub level: CosimLevel,
    /// The columns and rows of regions.
    pub grid: (u32, u32),
    /// The simulator.
    pub simulator: Simulator,
    /// The version that the simulator reports.
    pub simulator_version: String,
    /// The SHA-256 of the Verilog: the hash of the text that `sha256sum` prints for all files in
    /// the order of their names. The area estimate reports the same hash for the same Verilog.
    pub rtl_sha256: String,
    /// The netlist that was simulated instead of the Verilog, if there was one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub netlist: Option<NetlistRecord>,
    /// The seed of the vectors.
    pub seed: u64,
    /// The number of sequences of frames; each begins with a reset.
    pub sequences: u64,
    /// The number of frames that were streamed.
    pub frames: u64,
    /// The number of clock edges, up to the first mismatch.
    pub clocks: u64,
    /// The number of values that were compared: every output of every region at each of these
    /// edges.
    pub comparisons: u64,
    /// The number of times that each situation occurred that the design can have; empty if only
    /// frames were played.
    #[serde(default)]
    pub situations: Occurrences,
    /// The first mismatch.
    pub mismatch: Option<Mismatch>,
    /// The folder that replays the mismatch.
    pub replay: Option<PathBuf>,
    /// The file with the waves of a run without a mismatch, if they were asked for.
    pub waves: Option<PathBuf>,
    /// The time of each step.
    pub seconds: StepSeconds,
}

impl CosimReport {
    /// Returns true if model and RTL agree. A run without a comparison has not passed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.mismatch.is_none() && self.comparisons > 0
    }
}

/// The durations of the steps, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepSeconds {
    /// The time to make the vectors and run the model.
    pub vectors: f64,
    /// The time to build the simulation; almost zero if it was found in the cache.
    pub build: f64,
    /// The time to simulate and compare.
    pub run: f64,
}

impl fmt::Display for CosimReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, frames, clocks, comparisons, .. } = self;
        match &self.mismatch {
            None if !self.passed() => write!(f, "{name}: nothing was compared"),
            None => write!(
                f,
                "{name}: {frames} frames, {clocks} clocks, {comparisons} values compared, no mismatch"
            ),
            Some(mismatch) => write!(f, "{name}: mismatch after {clocks} clocks: {mismatch}"),
        }
    }
}

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

/// Returns one test case per run, and a failed or skipped one if some of the given Verilog was not
/// simulated.
#[must_use]
pub fn junit_xml(summary: &CosimSummary) -> String {
    let mut suite = TestSuite::new("foveate cosim");
    let class = format!("foveate.{}", summary.design);
    for report in &summary.runs {
        let mut case = TestCase::new(report.name.clone(), status(report));
        let seconds = report.seconds;
        let total = seconds.vectors + seconds.build + seconds.run;
        case.set_classname(class.clone());
        case.set_time(Duration::try_from_secs_f64(total).unwrap_or_default());
        case.set_system_out(report.to_string());
        suite.add_test_case(case);
    }
    for name in &summary.not_run {
        let mut status = TestCaseStatus::skipped();
        status.set_message("not run, because an earlier run has a mismatch");
        let mut case = TestCase::new(name.clone(), status);
        case.set_classname(class.clone());
        suite.add_test_case(case);
    }
    let reached_all = summary.not_simulated.is_empty() && summary.not_elaborated.is_empty();
    if !reached_all {
        let mut status = if summary.must_be_whole {
            TestCaseStatus::non_success(NonSuccessKind::Failure)
        } else {
            TestCaseStatus::skipped()
        };
        status.set_type("not simulated").set_message(summary.describe_unreached());
        let mut case = TestCase::new("every file and every parameter value is simulated", status);
        case.set_classname(class);
        suite.add_test_case(case);
    }
    rendered(suite)
}

fn status(report: &CosimReport) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    match &report.mismatch {
        None if report.passed() => return TestCaseStatus::success(),
        None => status.set_type("nothing").set_message("nothing was compared"),
        Some(mismatch) => status.set_type("mismatch").set_message(mismatch.to_string()),
    };
    let ports = report.mismatch.iter().flat_map(|mismatch| &mismatch.ports);
    let ports = ports.map(|port| format!("{port}\n")).collect::<String>();
    let replay = report.replay.as_ref().map_or_else(String::new, |replay| {
        format!("replay it with {}/replay.sh", replay.display())
    });
    status.set_description(ports + &replay);
    status
}

/// Returns one test case for a run without a result.
#[must_use]
pub fn junit_error(name: &str, problem: &str) -> String {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
    status.set_type("no result").set_message(problem);
    let mut suite = TestSuite::new("foveate cosim");
    suite.add_test_case(TestCase::new(name, status));
    rendered(suite)
}

fn rendered(suite: TestSuite) -> String {
    let mut report = Report::new("foveate cosim");
    report.add_test_suite(suite);
    report.to_string().expect("writing into memory does not fail")
}
