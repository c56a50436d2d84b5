// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the options of `foveate cosim` ask to be simulated.

use std::fs;
use std::path::Path;

use foveate_cosim::{Job, Level, Simulator, Stimulus};
use foveate_design::Design;
use foveate_emit::SourceFile;

use crate::args::{self, CosimArgs, SimulatorChoice};
use crate::error::CliError;

/// Clocks of the whole frame that are enough where nobody asked for it: some ten seconds of a raster core.
const ENOUGH: u64 = 40_000_000;

/// The co-simulations, the smallest first; at least one.
pub(super) fn jobs(args: &CosimArgs) -> Result<Vec<Job>, CliError> {
    let (design, frames) = args.design.with_frames(&args.inputs, args.frames)?;
    let rtl = args.rtl.as_deref().map(read_rtl).transpose()?;
    let job = |level| {
        let rounds = args.rounds.unwrap_or(match level {
            Level::Rpu => 3,
            Level::Rcm { .. } | Level::Full => 1,
        });
        // The whole frame is simulated beside a small one, which all sequences have shown.
        let enough = (!args.full && level == Level::Full).then_some(ENOUGH);
        let stimulus = Stimulus { level, seed: args.seed, rounds, frames: frames.clone(), enough };
        let mut job = Job::new(&design, stimulus, &args.replay)?;
        job.simulator = match args.simulator {
            SimulatorChoice::Verilator => Simulator::Verilator,
            SimulatorChoice::Iverilog => Simulator::Iverilog,
        };
        job.trace = args.trace;
        job.sources = rtl.clone().unwrap_or(job.sources);
        Ok(job)
    };
    levels(args, &design, rtl.as_deref())?.into_iter().map(job).collect()
}

/// Whether all of the Verilog is to be simulated: it is given, and no part of it was asked for.
pub(super) fn is_whole(args: &CosimArgs) -> bool {
    args.rtl.is_some() && args.level.is_none() && !args.full
}

fn levels(
    args: &CosimArgs,
    design: &Design,
    rtl: Option<&[SourceFile]>,
) -> Result<Vec<Level>, CliError> {
    let one = match (args.full, args.level, args.grid) {
        (true, ..) => Level::Full,
        (false, Some(args::Level::Rcm), Some((columns, rows))) => Level::Rcm { columns, rows },
        (false, Some(args::Level::Rcm), None) => Level::sample(design),
        (false, _, Some(_)) => {
            let message = "--grid is for --level rcm; add it or leave --grid out";
            return Err(CliError::Usage(message.to_owned()));
        }
        (false, Some(args::Level::Rpu), None) => Level::Rpu,
        (false, None, None) => match rtl {
            Some(sources) => return Ok(Level::all_of(design, sources)),
            None => Level::Rpu,
        },
    };
    Ok(vec![one])
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
