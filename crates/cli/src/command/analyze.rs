// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate analyze`: the paper's studies as tables and charts.

use foveate_explore::studies::{STUDY_FOLDER, Study, StudyReport, StudyRequest, analyze};
use foveate_media::ImageRelation;

use crate::args::{AnalyzeArgs, check_output, warn_about_inputs};
use crate::error::CliError;
use crate::output;
use crate::progress::RunTerminal;

pub(crate) fn run(args: &AnalyzeArgs) -> Result<(), CliError> {
    let own_options = [
        ("--boxes", !args.boxes.is_empty(), Study::Recall),
        ("--sensor-events", args.sensor_events.is_some(), Study::Sensor),
    ];
    for (option, is_given, own) in own_options {
        if is_given && args.study.0 != own {
            let (own, study) = (own.name(), args.study.0.name());
            return Err(CliError::Usage(format!(
                "{option} is only for the study {own}, not for {study}; leave it out"
            )));
        }
    }
    check_output(&args.output, STUDY_FOLDER, args.force, &args.inputs)?;
    let config = args.design.config()?;
    let input = args.input.options(ImageRelation::Clip);
    let request = StudyRequest {
        study: args.study.0,
        inputs: &args.inputs,
        input: &input,
        config: &config,
        sensor_events: args.sensor_events.as_deref(),
        sensor_start_us: args.sensor_start.unwrap_or(0),
        boxes: &args.boxes,
    };
    warn_about_inputs(&args.inputs, &input);
    let hooks = RunTerminal::new(args.quiet)?;
    let report = analyze(&request, &args.output, args.force, &hooks);
    hooks.progress.finish();
    let report = report?;
    output::print_result((args.json, args.quiet), &report, || text(args, &report))?;
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
