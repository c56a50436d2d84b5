// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate stress`: hard cases, with a check of their results, and a design on disturbed clips.

use std::sync::atomic::Ordering;

use foveate_explore::{
    DisturbanceRow, DisturbedDesign, ErrorSourceRow, ExploreError, disturb_design,
};
use foveate_measure::stress::{CaseRow, RunDepth};
use foveate_media::{ImageRelation, PlaybackError};
use foveate_output::report::ReportTable;
use serde::Serialize;

use crate::args::{DesignArgs, StressArgs, warn_about_inputs};
use crate::error::CliError;
use crate::progress::{Progress, RunTerminal};
use crate::{interrupt, output};

#[derive(Serialize)]
struct StressReport<'a> {
    format_version: u32,
    holds: bool,
    rows: &'a [CaseRow],
}

#[derive(Serialize)]
struct DisturbanceReport<'a> {
    format_version: u32,
    design: String,
    task: String,
    rows: &'a [DisturbanceRow],
    sources: &'a [ErrorSourceRow],
    problems: &'a [String],
}

pub(crate) fn run(args: &StressArgs) -> Result<(), CliError> {
    if !args.inputs.is_empty() {
        return disturb(args);
    }
    if args.has_design() {
        return Err(CliError::Usage(
            "a design is shown disturbed clips; give an input, for example `foveate stress --config camera.toml street.mp4`"
                .to_owned(),
        ));
    }
    let interrupted = interrupt::stop_flag()?;
    let progress = Progress::new(args.quiet);
    let done = |done: usize, all: usize| progress.report_steps("cases", done as u64, all as u64);
    let depth = if args.short { RunDepth::Short } else { RunDepth::Full };
    let rows =
        foveate_measure::stress::run_cases(depth, &done, &|| interrupted.load(Ordering::Relaxed));
    progress.finish();
    let broken = rows.iter().filter(|row| !row.is_as_expected).count();
    let holds = broken == 0 && !interrupted.load(Ordering::Relaxed);
    let report = StressReport { format_version: 1, holds, rows: &rows };
    let shown = || if args.markdown { markdown(&rows) } else { text(&rows) };
    output::print_result((args.json, false), &report, shown)?;
    match (interrupted.load(Ordering::Relaxed), broken) {
        (true, _) => Err(CliError::Stopped { done: format!("{} rows", rows.len()) }),
        (false, 0) => Ok(()),
        (false, _) => Err(CliError::Failed(format!("{broken} of {} cases failed", rows.len()))),
    }
}

/// Shows a design disturbed clips.
fn disturb(args: &StressArgs) -> Result<(), CliError> {
    let design = args.design.config()?;
    let mut task = DesignArgs::task(args.task.as_deref())?;
    // The frames have the size of the task.
    let (frame, own) = (&mut task.camera.frame, &design.camera.frame);
    frame.width = frame.width.or(own.width);
    frame.height = frame.height.or(own.height);
    let input = args.input.options(ImageRelation::Clip);
    warn_about_inputs(&args.inputs, &input);
    let terminal = RunTerminal::new(args.quiet)?;
    let cameras = (&design.camera, &task.camera);
    let found = disturb_design(cameras, &args.inputs, &input, &terminal);
    terminal.progress.finish();
    let DisturbedDesign { rows, sources, problems } = match found {
        Err(ExploreError::Playback(PlaybackError::Interrupted)) => {
            return Err(CliError::Stopped { done: "some of the disturbances".to_owned() });
        }
        other => other?,
    };
    let report = DisturbanceReport {
        format_version: 1,
        design: design.to_toml(),
        task: task.to_toml(),
        rows: &rows,
        sources: &sources,
        problems: &problems,
    };
    output::print_result((args.json, false), &report, || {
        let flips = rows.first().map_or(0.0, |row| row.flips);
        let sources = source_table(&sources, flips, args.markdown);
        format!("{}\n{sources}", disturbed_table(&rows, args.markdown))
    })?;
    match problems.is_empty() {
        true => Ok(()),
        false => {
            Err(CliError::Failed(format!("not all of the input was read: {}", problems.join("; "))))
        }
    }
}

/// Returns the figures with all disturbances as a table.
fn disturbed_table(rows: &[DisturbanceRow], is_markdown: bool) -> String {
    let names = ["disturbance", "flips %", "missed %", "false alarms %", "PSNR dB", "bytes/frame"];
    let cells = rows.iter().map(|row| {
        [
            row.disturbance.clone(),
            percent(row.flips),
            percent(row.missed),
            percent(row.false_alarms),
            row.psnr_ideal.map_or_else(|| "same".to_owned(), |psnr| format!("{psnr:.1}")),
            format!("{:.0}", row.bytes_per_frame),
        ]
    });
    figure_table(names, cells, is_markdown)
}

/// Returns a table of the sources of the design's flips. The interaction is computed from the
/// rounded figures, so that they add up.
fn source_table(rows: &[ErrorSourceRow], flips: f64, is_markdown: bool) -> String {
    let mut rest = rounded_percent(flips);
    let cells = rows.iter().enumerate().map(|(number, row)| {
        let flips = row.flips.map(rounded_percent);
        let flips = flips.map(|flips| if number + 1 == rows.len() { rest } else { flips });
        rest -= flips.unwrap_or(0.0);
        let interval =
            row.interval.map(|[least, most]| format!("{} to {}", percent(least), percent(most)));
        [
            row.source.to_owned(),
            flips.map_or_else(|| "none".to_owned(), |flips| percent(flips / 100.0)),
            row.reason.clone().or(interval).unwrap_or_default(),
        ]
    });
    figure_table(["source", "flips %", "interval %"], cells, is_markdown)
}

/// Returns a share in percent, rounded to two digits after the point; never -0.
fn rounded_percent(share: f64) -> f64 {
    (1e4 * share).round() / 100.0 + 0.0
}

fn percent(share: f64) -> String {
    format!("{:.2}", rounded_percent(share))
}

fn figure_table<const N: usize>(
    names: [&str; N],
    rows: impl Iterator<Item = [String; N]>,
    is_markdown: bool,
) -> String {
    if is_markdown {
        let rows = rows.map(Vec::from).collect();
        return ReportTable { rows, ..ReportTable::of_words(names) }.markdown();
    }
    let line = |cells: [String; N]| {
        let rest: String = cells[1..].iter().map(|cell| format!("  {cell:>14}")).collect();
        format!("{:<14}{rest}\n", cells[0])
    };
    std::iter::once(names.map(str::to_owned)).chain(rows).map(line).collect()
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
    let names = ["case", "designs", "expected", "observed", "worst error", "verdict"];
    let row = |row: &CaseRow| {
        let CaseRow { case, designs, expected, observed, worst, .. } = row;
        [*case, designs, expected, observed, worst, verdict(row)].map(str::to_owned).to_vec()
    };
    let rows = rows.iter().map(row).collect();
    ReportTable { rows, ..ReportTable::of_words(names) }.markdown()
}
