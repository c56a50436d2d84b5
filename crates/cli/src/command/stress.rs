// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate stress`: hard cases, with a check of their results.

use std::sync::atomic::Ordering;

use foveate_stress::{CaseRow, RunDepth};
use serde::Serialize;

use crate::args::StressArgs;
use crate::error::CliError;
use crate::progress::Progress;
use crate::{interrupt, output};

#[derive(Serialize)]
struct StressReport<'a> {
    format_version: u32,
    holds: bool,
    rows: &'a [CaseRow],
}

pub(crate) fn run(args: &StressArgs) -> Result<(), CliError> {
    let interrupted = interrupt::stop_flag()?;
    let progress = Progress::new(args.quiet);
    let done = |done: usize, all: usize| progress.report_steps("cases", done as u64, all as u64);
    let depth = if args.short { RunDepth::Short } else { RunDepth::Full };
    let rows = foveate_stress::run_cases(depth, &done, &|| interrupted.load(Ordering::Relaxed));
    progress.finish();
    let broken = rows.iter().filter(|row| !row.is_as_expected).count();
    let holds = broken == 0 && !interrupted.load(Ordering::Relaxed);
    if args.json {
        output::print_json(&StressReport { format_version: 1, holds, rows: &rows })?;
    } else if args.markdown {
        output::print_text(&markdown(&rows))?;
    } else {
        output::print_text(&text(&rows))?;
    }
    match (interrupted.load(Ordering::Relaxed), broken) {
        (true, _) => Err(CliError::Stopped { done: format!("{} rows", rows.len()) }),
        (false, 0) => Ok(()),
        (false, _) => Err(CliError::Failed(format!("{broken} of {} cases failed", rows.len()))),
    }
}

fn verdict(row: &CaseRow) -> &'static str {
    if row.is_as_expected { "ok" } else { "FAILED" }
}

/// Returns two paragraphs per row, so that each row fits into a narrow terminal.
fn text(rows: &[CaseRow]) -> String {
    let width = output::text_width();
    let mut text = String::new();
    for row in rows {
        let CaseRow { case, designs, expected, observed, worst, .. } = row;
        let first = format!("{:<6} {case}: {designs}", verdict(row));
        let second = format!("expected {expected}; observed {observed}; worst error {worst}");
        let indented = textwrap::Options::new(width).subsequent_indent("       ");
        text += &textwrap::fill(&first, &indented);
        text.push('\n');
        text += &textwrap::fill(&second, indented.initial_indent("       "));
        text.push('\n');
    }
    let held = rows.iter().filter(|row| row.is_as_expected).count();
    text + &format!("{held} of {} cases hold\n", rows.len())
}

fn markdown(rows: &[CaseRow]) -> String {
    let mut text = "| case | designs | expected | observed | worst error | verdict |\n\
                    | --- | --- | --- | --- | --- | --- |\n"
        .to_owned();
    for row in rows {
        let CaseRow { case, designs, expected, observed, worst, .. } = row;
        let verdict = verdict(row);
        text +=
            &format!("| {case} | {designs} | {expected} | {observed} | {worst} | {verdict} |\n");
    }
    text
}
