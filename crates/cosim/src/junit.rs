// SPDX-License-Identifier: MIT OR Apache-2.0
//! Results as JUnit XML, which test servers read.

use crate::report::CosimReport;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::time::Duration;

/// One test case per report.
#[must_use]
pub fn junit_xml(reports: &[CosimReport]) -> String {
    let mut suite = TestSuite::new("foveate cosim");
    for report in reports {
        let status = match &report.mismatch {
            None => TestCaseStatus::success(),
            Some(mismatch) => {
                let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                status.set_type("mismatch").set_message(mismatch.to_string());
                if let Some(replay) = &report.replay {
                    status
                        .set_description(format!("replay it with {}/replay.sh", replay.display()));
                }
                status
            }
        };
        let mut case = TestCase::new(report.name.clone(), status);
        let seconds = report.seconds;
        let total = seconds.vectors + seconds.build + seconds.run;
        case.set_classname(format!("foveate.{}", report.design));
        case.set_time(Duration::try_from_secs_f64(total).unwrap_or_default());
        case.set_system_out(report.to_string());
        suite.add_test_case(case);
    }
    rendered(suite)
}

/// One test case for a run that came to no result.
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
    // Writing into memory cannot fail.
    report.to_string().unwrap_or_default()
}
