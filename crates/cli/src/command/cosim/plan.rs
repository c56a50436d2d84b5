// SPDX-License-Identifier: MIT OR Apache-2.0
//! The co-simulations that the options of `foveate cosim` ask for.

use std::fs;
use std::path::Path;

use foveate_cosim::{BusJob, CosimJob, CosimLevel, Simulator, Stimulus, core_prefixes};
use foveate_design::Design;
use foveate_emit::{Prefix, SourceFile, Top};
use foveate_tools::check_source_name;

use crate::args::{self, CosimArgs, SimulatorChoice};
use crate::error::CliError;

/// The largest Verilog file that is read, in bytes. The largest generated file has a few MiB.
const VERILOG_LIMIT: u64 = 1 << 26;
/// The clocks of the whole frame that are enough if `--full` is not given: some ten seconds of
/// simulation of a raster core.
const ENOUGH_CLOCKS: u64 = 40_000_000;

/// A co-simulation: of an array clock by clock, or of a core on AXI packet by packet.
pub(super) enum PlannedCosim {
    Array(Box<CosimJob>),
    Axi(Box<BusJob>),
}

impl PlannedCosim {
    pub(super) fn name(&self) -> String {
        match self {
            Self::Array(job) => job.name(),
            Self::Axi(job) => job.name(),
        }
    }
}

/// The co-simulations of a command, and the inputs that they share.
pub(super) struct CosimPlan {
    pub(super) design: Design,
    /// The given Verilog; `None` if it is generated.
    pub(super) rtl: Option<Vec<SourceFile>>,
    pub(super) prefix: Prefix,
    /// The co-simulations, the smallest first; there is at least one.
    pub(super) jobs: Vec<PlannedCosim>,
}

impl CosimPlan {
    /// Makes the core on AXI write its packets into `file`.
    pub(super) fn keep_packets(&mut self, file: &Path) {
        for work in &mut self.jobs {
            if let PlannedCosim::Axi(job) = work {
                job.packets = Some(file.to_owned());
            }
        }
    }
}

pub(super) fn plan(args: &CosimArgs) -> Result<CosimPlan, CliError> {
    let (design, frames) = args.design.with_frames(&args.inputs, args.frames)?;
    let rtl = args.rtl.as_deref().map(read_rtl).transpose()?;
    let prefix = match rtl.as_deref() {
        Some(sources) => core_prefix(args, &design, sources)?,
        None => Prefix::default(),
    };
    let array = |level| {
        let rounds = args.rounds.unwrap_or(match level {
            CosimLevel::Rpu => 3,
            CosimLevel::Rcm { .. } | CosimLevel::Full => 1,
        });
        // The whole frame is simulated in addition to a small frame, to which all sequences are
        // applied.
        let enough = (!args.full && level == CosimLevel::Full).then_some(ENOUGH_CLOCKS);
        let stimulus = Stimulus {
            level,
            seed: args.seed,
            rounds,
            frames: frames.clone(),
            sufficient_clocks: enough,
        };
        let mut job = CosimJob::new(&design, stimulus, &args.replay)?;
        job.simulator = match args.simulator {
            SimulatorChoice::Verilator => Simulator::Verilator,
            SimulatorChoice::Iverilog => Simulator::Iverilog,
        };
        job.trace = args.trace;
        job.sources = rtl.clone().unwrap_or(job.sources);
        job.prefix = prefix.clone();
        Ok(PlannedCosim::Array(Box::new(job)))
    };
    let levels = array_levels(args, &design, rtl.as_deref(), &prefix)?;
    let mut works: Vec<PlannedCosim> =
        levels.into_iter().map(array).collect::<Result<_, CliError>>()?;
    if let Some(mut job) = axi_job(args, &design)? {
        job.seed = args.seed;
        job.rounds = args.rounds.unwrap_or(1);
        job.frames = frames;
        job.sources = rtl.clone().unwrap_or(job.sources);
        job.prefix = prefix.clone();
        works.push(PlannedCosim::Axi(Box::new(job)));
    }
    Ok(CosimPlan { design, rtl, prefix, jobs: works })
}

/// Returns the job of the core on AXI, if it is to be simulated.
fn axi_job(args: &CosimArgs, design: &Design) -> Result<Option<BusJob>, CliError> {
    let is_part = args.full || args.netlist || args.simulator == SimulatorChoice::Iverilog;
    let packets = args.packets.clone();
    let is_asked =
        args.level == Some(args::DesignPart::Axi) || packets.is_some() || args.end_to_end.is_some();
    let option = match (&args.packets, &args.end_to_end) {
        (Some(_), _) => "--packets",
        (None, Some(_)) => "--end-to-end",
        (None, None) => "--level axi",
    };
    if is_asked && is_part {
        let message = format!(
            "{option} cannot be combined with --full, --netlist or --simulator iverilog; leave these out"
        );
        return Err(CliError::Usage(message));
    }
    let wanted = is_asked || (args.level.is_none() && !is_part);
    match BusJob::new(design, &args.replay) {
        Some(job) if wanted => Ok(Some(BusJob { packets, trace: args.trace, ..job })),
        None if is_asked => Err(CliError::Usage(format!(
            "{option} is for a core on AXI; this design has hardware.interface = \"ports\", so set it to \"axi\""
        ))),
        _ => Ok(None),
    }
}

/// Returns true if all of the Verilog is to be simulated: it is given, and no part of it is chosen.
pub(super) fn is_whole_folder(args: &CosimArgs) -> bool {
    args.rtl.is_some() && args.level.is_none() && !args.full
}

fn array_levels(
    args: &CosimArgs,
    design: &Design,
    rtl: Option<&[SourceFile]>,
    prefix: &Prefix,
) -> Result<Vec<CosimLevel>, CliError> {
    let one = match (args.full, args.level, args.grid) {
        (true, ..) => CosimLevel::Full,
        (false, Some(args::DesignPart::Rcm), Some((columns, rows))) => {
            CosimLevel::Rcm { columns, rows }
        }
        (false, Some(args::DesignPart::Rcm), None) => CosimLevel::small_array(design),
        (false, _, Some(_)) => {
            let message = "--grid is for --level rcm; add it or leave --grid out";
            return Err(CliError::Usage(message.to_owned()));
        }
        (false, Some(args::DesignPart::Rpu), None) => CosimLevel::Rpu,
        (false, Some(args::DesignPart::Axi), None) => return Ok(Vec::new()),
        (false, None, None) => match rtl {
            Some(sources) => return Ok(CosimLevel::for_sources(design, sources, prefix)),
            None => CosimLevel::Rpu,
        },
    };
    Ok(vec![one])
}

/// Returns the prefix of the core in these files: the given one, or the only one in the files.
fn core_prefix(
    args: &CosimArgs,
    design: &Design,
    sources: &[SourceFile],
) -> Result<Prefix, CliError> {
    if args.prefix.is_some() {
        return Ok(Prefix::from_request(args.prefix.as_deref(), design)?);
    }
    let found = core_prefixes(sources);
    if found.len() <= 1 {
        return Ok(found.into_iter().next().unwrap_or_default());
    }
    let tops = found.iter().map(|prefix| format!("`{}`", prefix.prefixed_name(Top::Rcm.module())));
    let message = format!(
        "the folder of --rtl holds several cores, {}; choose one with --prefix, such as --prefix {}",
        tops.collect::<Vec<_>>().join(", "),
        found.first().map_or("", Prefix::text)
    );
    Err(CliError::Usage(message))
}

/// Reads the Verilog files of a folder, in the order of their names.
fn read_rtl(folder: &Path) -> Result<Vec<SourceFile>, CliError> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(CliError::io("read the folder", folder))? {
        let path = entry.map_err(CliError::io("read the folder", folder))?.path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
        if let (Some(name), true) = (name, path.extension().is_some_and(|e| e == "v")) {
            check_source_name(&name)
                .map_err(|error| CliError::Usage(format!("{error}; rename the file of --rtl")))?;
            let contents = foveate_tools::read_text(&path, VERILOG_LIMIT)
                .map_err(CliError::io("read", &path))?;
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
