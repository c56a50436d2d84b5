// SPDX-License-Identifier: MIT OR Apache-2.0
//! Results as JUnit XML, which test servers read.

use crate::report::CosimReport;
use crate::summary::CosimSummary;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::time::Duration;

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
