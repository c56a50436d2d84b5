// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate simulate`: images in; arrays, tables, pictures and video out.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use foveate_simulator::{
    Bandwidth, FrameRate, Hooks, InputOptions, Progress, RunOptions, Simulation, Summary, Traffic,
    open,
};
use indicatif::ProgressBar;

use crate::args::SimulateArgs;
use crate::error::CliError;
use crate::{output, progress};

pub(crate) fn run(args: &SimulateArgs) -> Result<(), CliError> {
    let config = args.design.read()?;
    let input = InputOptions { frames: args.frames, frame_rate: FrameRate::new(args.fps, 1)? };
    let source = open(&args.inputs, &config, &input)?;
    let simulation = Simulation::new(&config, source)?;
    let options = RunOptions { overwrite: args.force, ..args.outputs.options() };
    let mut hooks = Terminal::new(args.quiet)?;
    let summary = simulation.run(&args.output, &options, &mut hooks);
    hooks.bar.finish_and_clear();
    let summary = summary?;
    if args.json { output::json(&summary) } else { output::text(&text(args, &summary)) }
}

/// Draws progress and listens for Ctrl-C.
struct Terminal {
    bar: ProgressBar,
    interrupted: Arc<AtomicBool>,
}

impl Terminal {
    fn new(quiet: bool) -> Result<Self, CliError> {
        let interrupted = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&interrupted);
        ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed))
            .map_err(|e| CliError::Usage(format!("cannot listen for Ctrl-C: {e}")))?;
        Ok(Self { bar: progress::bar(quiet, 0, "frames"), interrupted })
    }
}

impl Hooks for Terminal {
    fn progress(&mut self, progress: Progress) {
        if let Some(total) = progress.total {
            self.bar.set_length(total);
        }
        self.bar.set_position(progress.done);
    }

    fn cancelled(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }
}

fn text(args: &SimulateArgs, summary: &Summary) -> String {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    format!(
        "{}: {} frames of {} x {} pixels, {} regions\n\
         active {}  SRS {}  TRS {}\n\
         {} pixels in, {} forwarded\n\
         {}",
        args.output.display(),
        summary.frames,
        summary.width,
        summary.height,
        summary.regions,
        percent(summary.active_share),
        percent(summary.srs_share),
        percent(summary.trs_share),
        summary.pixels_in,
        summary.pixels_forwarded,
        traffic(&summary.bandwidth),
    )
}

/// What the cameras send, a line for each.
fn traffic(bandwidth: &Bandwidth) -> String {
    let per_second =
        |rate: Option<f64>| rate.map_or(String::new(), |rate| format!(" ({rate:.0}/s)"));
    let line = |name: &str, traffic: &Traffic| {
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
