// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate cosim`: model against RTL, every output at every clock.

use std::fs;
use std::path::Path;

use foveate_cosim::{
    CosimError, CosimReport, Job, Level, Netlist, Progress, Simulator, Stimulus, junit_error,
    junit_xml,
};
use foveate_emit::SourceFile;
use foveate_staging::{check_file, write_file};
use foveate_toolchain::Cache;

use crate::args::{self, CosimArgs, SimulatorChoice};
use crate::error::CliError;
use crate::progress::Progress as Shown;
use crate::{interrupt, output};

pub(crate) fn run(args: &CosimArgs) -> Result<(), CliError> {
    let (design, frames) = args.design.with_frames(&args.inputs, args.frames)?;
    let level = level(args)?;
    let rounds = args.rounds.unwrap_or(match level {
        Level::Rpu => 3,
        Level::Rcm { .. } | Level::Full => 1,
    });
    let stimulus = Stimulus { level, seed: args.seed, rounds, frames };
    let mut job = Job::new(&design, stimulus, &args.replay)?;
    job.simulator = match args.simulator {
        SimulatorChoice::Verilator => Simulator::Verilator,
        SimulatorChoice::Iverilog => Simulator::Iverilog,
    };
    job.trace = args.trace;
    if let Some(folder) = &args.rtl {
        job.sources = read_rtl(folder)?;
    }

    if let Some(file) = &args.junit {
        check_file(file)?;
    }
    let (toolchain, cache) = (interrupt::toolchain()?, Cache::from_env()?);
    let shown = Shown::new(args.quiet);
    if args.netlist {
        shown.work("synthesizing with Yosys");
        job.netlist = Some(Netlist::of(&job, &toolchain, &cache)?);
        job.simulator = Simulator::Iverilog;
    }

    let report = job.run(&toolchain, &cache, &mut |step| show(&shown, step));
    shown.finish();
    let written = write_junit(args, &job, &report);
    let report = report?;
    tell(args, &report)?;
    if !report.passed() {
        if let Err(error) = written {
            eprintln!("foveate: {error}");
        }
        return Err(CliError::Failed("model and RTL do not agree".to_owned()));
    }
    written
}

fn tell(args: &CosimArgs, report: &CosimReport) -> Result<(), CliError> {
    if args.json { output::json(report) } else { output::text(&text(report)) }
}

/// The result for a CI server, also if there is none because a tool failed.
fn write_junit(
    args: &CosimArgs,
    job: &Job,
    report: &Result<CosimReport, CosimError>,
) -> Result<(), CliError> {
    let Some(file) = &args.junit else { return Ok(()) };
    let xml = match report {
        Ok(report) => junit_xml(std::slice::from_ref(report)),
        Err(error) => junit_error(&job.name(), &error.to_string()),
    };
    Ok(write_file(file, xml.as_bytes())?)
}

fn text(report: &CosimReport) -> String {
    let seconds = report.seconds;
    let mut text = format!(
        "{report}\ndesign {}, {} x {} regions, {}, seed {}\n{:.1} s vectors, {:.1} s build, {:.1} s run\n",
        report.design,
        report.grid.0,
        report.grid.1,
        report.simulator_version,
        report.seed,
        seconds.vectors,
        seconds.build,
        seconds.run
    );
    if let Some(replay) = &report.replay {
        text += &format!("replay it with {}\n", replay.join("replay.sh").display());
    }
    if let Some(waves) = &report.waves {
        text += &format!("waves in {}\n", waves.display());
    }
    text
}

fn level(args: &CosimArgs) -> Result<Level, CliError> {
    match (args.full, args.level, args.grid) {
        (true, ..) => Ok(Level::Full),
        (false, args::Level::Rcm, Some((columns, rows))) => Ok(Level::Rcm { columns, rows }),
        (false, args::Level::Rcm, None) => Ok(Level::Rcm { columns: 2, rows: 2 }),
        (false, args::Level::Rpu, None) => Ok(Level::Rpu),
        (false, args::Level::Rpu, Some(_)) => {
            Err(CliError::Usage("--grid is for --level rcm; add it or leave --grid out".to_owned()))
        }
    }
}

/// The Verilog files of a folder, in the order of their names.
fn read_rtl(folder: &Path) -> Result<Vec<SourceFile>, CliError> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(CliError::io("read the folder", folder))? {
        let path = entry.map_err(CliError::io("read the folder", folder))?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        if let (Some(name), true) = (name, path.extension().is_some_and(|e| e == "v")) {
            let contents = fs::read_to_string(&path).map_err(CliError::io("read", &path))?;
            files.push(SourceFile { path: format!("rtl/{name}"), contents });
        }
    }
    if files.is_empty() {
        let shown = folder.display();
        return Err(CliError::Usage(format!(
            "`{shown}` holds no .v file; name a folder with the RTL"
        )));
    }
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(files)
}

fn show(shown: &Shown, step: Progress) {
    match step {
        Progress::Vectors { done, total } => shown.steps("vectors", done, total),
        Progress::Simulation { clocks } => {
            shown.work(&format!("building and simulating {clocks} clocks"));
        }
    }
}
