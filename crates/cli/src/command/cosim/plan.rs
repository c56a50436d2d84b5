// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the options of `foveate cosim` ask to be simulated.

use std::fs;
use std::path::Path;

use foveate_cosim::{Job, Level, Simulator, Stimulus, prefixes};
use foveate_design::Design;
use foveate_emit::{Prefix, SourceFile, Top};

use crate::args::{self, CosimArgs, SimulatorChoice};
use crate::error::CliError;

/// Clocks of the whole frame that are enough where nobody asked for it: some ten seconds of a raster core.
const ENOUGH: u64 = 40_000_000;

/// The co-simulations, the smallest first; at least one.
pub(super) fn jobs(args: &CosimArgs) -> Result<Vec<Job>, CliError> {
    let (design, frames) = args.design.with_frames(&args.inputs, args.frames)?;
    let rtl = args.rtl.as_deref().map(read_rtl).transpose()?;
    let prefix = match rtl.as_deref() {
        Some(sources) => prefix_of(args, &design, sources)?,
        None => Prefix::default(),
    };
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
        job.prefix = prefix.clone();
        Ok(job)
    };
    levels(args, &design, rtl.as_deref(), &prefix)?.into_iter().map(job).collect()
}

/// Whether all of the Verilog is to be simulated: it is given, and no part of it was asked for.
pub(super) fn is_whole(args: &CosimArgs) -> bool {
    args.rtl.is_some() && args.level.is_none() && !args.full
}

fn levels(
    args: &CosimArgs,
    design: &Design,
    rtl: Option<&[SourceFile]>,
    prefix: &Prefix,
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
            Some(sources) => return Ok(Level::all_of(design, sources, prefix)),
            None => Level::Rpu,
        },
    };
    Ok(vec![one])
}

/// The prefix of the core in these files: the one that is asked for, or the only one that is there.
fn prefix_of(
    args: &CosimArgs,
    design: &Design,
    sources: &[SourceFile],
) -> Result<Prefix, CliError> {
    if args.prefix.is_some() {
        return Ok(Prefix::asked(args.prefix.as_deref(), design)?);
    }
    let found = prefixes(sources);
    if found.len() <= 1 {
        return Ok(found.into_iter().next().unwrap_or_default());
    }
    let tops = found.iter().map(|prefix| format!("`{}`", prefix.name(Top::Rcm.module())));
    let message = format!(
        "the folder of --rtl holds several cores, {}; choose one with --prefix, such as --prefix {}",
        tops.collect::<Vec<_>>().join(", "),
        found.first().map_or("", Prefix::text)
    );
    Err(CliError::Usage(message))
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
