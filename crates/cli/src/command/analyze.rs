// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate analyze`: the paper's studies as tables and charts.

use foveate_footage::ImagesAs;
use foveate_staging::StagedFolder;
use foveate_studies::{Request, STUDY, Study, StudyReport, analyze};

use super::simulate::Terminal;
use crate::args::{AnalyzeArgs, warn_of};
use crate::error::CliError;
use crate::output;

pub(crate) fn run(args: &AnalyzeArgs) -> Result<(), CliError> {
    if !args.boxes.is_empty() && args.study.0 != Study::Recall {
        let study = args.study.0.name();
        return Err(CliError::Usage(format!(
            "--boxes belongs to the study recall, not to {study}; leave it out"
        )));
    }
    StagedFolder::check(&args.output, STUDY, args.force)?;
    let config = args.design.read()?;
    let input = args.input.options(ImagesAs::Clip);
    let request = Request {
        study: args.study.0,
        inputs: &args.inputs,
        input: &input,
        config: &config,
        sensor_events: args.sensor_events.as_deref(),
        sensor_start_us: args.sensor_start,
        boxes: &args.boxes,
    };
    warn_of(&args.inputs, &input);
    let hooks = Terminal::new(args.quiet)?;
    let report = analyze(&request, &args.output, args.force, &hooks);
    hooks.shown.finish();
    let report = report?;
    if args.json {
        output::json(&report)?;
    } else if !args.quiet {
        output::text(&text(args, &report))?;
    }
    if report.problems.is_empty() {
        return Ok(());
    }
    let place = args.output.display();
    Err(CliError::Failed(format!("`{place}` is not complete: {}", report.problems.join("; "))))
}

/// Returns the names of the files, and the table unless the chart shows its rows better.
fn text(args: &AnalyzeArgs, report: &StudyReport) -> String {
    let files = format!("{}: {}\n", args.output.display(), report.files.join(", "));
    match args.study.0 {
        Study::Activity | Study::MadHistogram => files,
        Study::Temporal
        | Study::Redundancy
        | Study::Size
        | Study::Threshold
        | Study::Sensor
        | Study::Recall => files + &report.markdown(),
    }
}
