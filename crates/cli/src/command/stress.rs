// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate stress`: hard cases, with a check of their results, and a design on disturbed clips.

use std::sync::atomic::Ordering;

use foveate_explore::{DisturbanceRow, ExploreError, disturb_design};
use foveate_footage::ImageRelation;
use foveate_playback::PlaybackError;
use foveate_stress::{CaseRow, RunDepth};
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
    let (rows, problems) = match found {
        Err(ExploreError::Playback(PlaybackError::Interrupted)) => {
            return Err(CliError::Stopped { done: "some of the disturbances".to_owned() });
        }
        other => other?,
    };
    if args.json {
        let (design, task) = (design.to_toml(), task.to_toml());
        let (rows, problems) = (&*rows, &*problems);
        output::print_json(&DisturbanceReport { format_version: 1, design, task, rows, problems })?;
    } else {
        output::print_text(&disturbed_table(&rows, args.markdown))?;
    }
    match problems.is_empty() {
        true => Ok(()),
        false => {
            Err(CliError::Failed(format!("not all of the input was read: {}", problems.join("; "))))
        }
    }
}

/// Returns the rows as a table, aligned or in Markdown.
fn disturbed_table(rows: &[DisturbanceRow], is_markdown: bool) -> String {
    let names = ["disturbance", "flips %", "missed %", "false alarms %", "PSNR dB", "bytes/frame"];
    let cells = |row: &DisturbanceRow| {
        let percent = |share: f64| format!("{:.2}", 100.0 * share);
        [
            row.disturbance.clone(),
            percent(row.flips),
            percent(row.missed),
            percent(row.false_alarms),
            row.psnr_ideal.map_or_else(|| "same".to_owned(), |psnr| format!("{psnr:.1}")),
            format!("{:.0}", row.bytes_per_frame),
        ]
    };
    let line = |cells: [String; 6]| {
        if is_markdown {
            return format!("| {} |\n", cells.join(" | "));
        }
        let [first, rest @ ..] = cells;
        let rest: String = rest.iter().map(|cell| format!("{cell:>16}")).collect();
        format!("{first:<14}{rest}\n")
    };
    let mut text = line(names.map(str::to_owned));
    if is_markdown {
        text += &format!("|{}\n", " --- |".repeat(names.len()));
    }
    text + &rows.iter().map(|row| line(cells(row))).collect::<String>()
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
