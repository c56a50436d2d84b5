// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate simulate`: video or images in; arrays, tables, pictures, video and packets out.

use std::path::Path;

use foveate_design::DesignConfig;
use foveate_media::{ClipPlan, ClipPlayer, ImageRelation, InputOptions, plan};
use foveate_simulator::{
    BandwidthComparison, BatchSummary, CameraTraffic, ClockFigures, DataSetPaths, RunOptions,
    RunSummary, SIMULATION_FOLDER, Simulation, run_batch,
};

use crate::args::{SimulateArgs, check_output, warn_about_inputs};
use crate::error::CliError;
use crate::output;
use crate::progress::RunTerminal;

pub(crate) fn run(args: &SimulateArgs) -> Result<(), CliError> {
    run_job(&SimulationJob {
        inputs: &args.inputs,
        config: args.design.config()?,
        input: args.input.options(ImageRelation::Clip),
        output: &args.output,
        options: RunOptions {
            overwrite: args.force,
            clocks: args.clocks.options()?,
            ..args.outputs.options()
        },
        json: args.json,
        quiet: args.quiet,
    })
}

/// A run of one clip or many, as `simulate` and `dataset` start it.
pub(super) struct SimulationJob<'a> {
    pub(super) inputs: &'a [String],
    pub(super) config: DesignConfig,
    pub(super) input: InputOptions,
    pub(super) output: &'a Path,
    pub(super) options: RunOptions,
    pub(super) json: bool,
    pub(super) quiet: bool,
}

/// Runs the job with progress and prints its summary. Fails if the result is not complete.
pub(super) fn run_job(job: &SimulationJob<'_>) -> Result<(), CliError> {
    let SimulationJob { inputs, config, input, output: folder, options, quiet, .. } = job;
    check_output(folder, SIMULATION_FOLDER, options.overwrite, inputs)?;
    let plan = plan(inputs, input)?;
    warn_about_inputs(inputs, input);
    let hooks = RunTerminal::new(*quiet)?;
    match plan {
        ClipPlan::One => {
            let player = ClipPlayer::open(inputs, &config.camera, input)?;
            let simulation = Simulation::new(config, player)?;
            let summary = simulation.run(folder, options, &hooks);
            hooks.progress.finish();
            let summary = summary?;
            output::print_result((job.json, job.quiet), &summary, || text(folder, &summary))?;
            hooks.check_complete(folder, summary.problem)
        }
        ClipPlan::Batch(clips) => {
            let summary = run_batch(&clips, config, input, folder, options, &hooks);
            hooks.progress.finish();
            let summary = summary?;
            output::print_result((job.json, job.quiet), &summary, || batch_text(folder, &summary))?;
            hooks.check_complete(folder, summary.problem)
        }
    }
}

fn batch_text(folder: &Path, summary: &BatchSummary) -> String {
    let mut text =
        format!("{}: {} clips, {} frames\n", folder.display(), summary.clips.len(), summary.frames);
    for clip in &summary.clips {
        let inputs = clip.inputs.join(" ");
        let result = match (clip.active_share, &clip.problem) {
            (Some(share), None) => format!("{} frames, active {:.1} %", clip.frames, 100.0 * share),
            (Some(_), Some(problem)) => format!("{} frames, NOT COMPLETE: {problem}", clip.frames),
            (None, problem) => format!("FAILED: {}", problem.as_deref().unwrap_or("not started")),
        };
        text.push_str(&format!("  {inputs}: {result}\n"));
    }
    text
}

pub(super) fn text(folder: &Path, summary: &RunSummary) -> String {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    format!(
        "{}: {} frames of {} x {} pixels, {} regions\n\
         active {}  SRS {}  TRS {}\n\
         {} pixels in, {} forwarded{}\n\
         {}{}{}",
        folder.display(),
        summary.frames,
        summary.width,
        summary.height,
        summary.regions,
        percent(summary.active_share),
        percent(summary.srs_share),
        percent(summary.trs_share),
        summary.pixels_in,
        summary.pixels_forwarded,
        means_text(summary),
        traffic_lines(&summary.bandwidth),
        summary.clocks.as_ref().map_or(String::new(), clocks_line),
        summary.data_set.as_ref().map_or(String::new(), |made| data_set_line(folder, made)),
    )
}

/// Returns the text about the means that irrelevant regions have sent, if they send means.
fn means_text(summary: &RunSummary) -> String {
    match (summary.means_sent, summary.summaries_sent) {
        (Some(means), Some(regions)) => format!(", {means} means of {regions} irrelevant regions"),
        _ => String::new(),
    }
}

/// Returns the line about the clocks of the core.
fn clocks_line(figures: &ClockFigures) -> String {
    let ClockFigures { last_clock, words, lost_regions } = figures;
    format!(
        "clocks        {words} words left, {lost_regions} regions lost, the last at clock {last_clock}\n"
    )
}

fn data_set_line(folder: &Path, made: &DataSetPaths) -> String {
    let labels = match (&made.labels, made.classes.len()) {
        (Some(labels), _) => format!(", labels in {}", folder.join(labels).display()),
        (None, 0) => String::new(),
        (None, classes) => format!(", {classes} classes"),
    };
    format!("data set in {}{labels}\n", folder.join(&made.images).display())
}

/// Returns a line with bytes and events for each camera.
fn traffic_lines(bandwidth: &BandwidthComparison) -> String {
    let per_second =
        |rate: Option<f64>| rate.map_or(String::new(), |rate| format!(" ({rate:.0}/s)"));
    let line = |name: &str, traffic: &CameraTraffic| {
        let events = traffic.events.map_or(String::new(), |events| {
            format!(", {events} events{}", per_second(traffic.events_per_second))
        });
        format!(
            "{name:<13} {} bytes{}{events}\n",
            traffic.bytes,
            per_second(traffic.bytes_per_second)
        )
    };
    let pixel = bandwidth.pixel.as_ref().map(|pixel| line("pixel events", pixel));
    line("raw video", &bandwidth.raw)
        + &line("region camera", &bandwidth.region)
        + &pixel.unwrap_or_default()
}
