// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate generate`: the core of a design as a folder.

use foveate_cosim::{CORE, ShippedBench, write_core};
use foveate_design::Design;
use foveate_emit::Prefix;
use foveate_tools::StagedFolder;
use serde::Serialize;

use crate::args::GenerateArgs;
use crate::error::CliError;
use crate::{interrupt, notice, output};

#[derive(Serialize)]
struct CoreListing<'a> {
    format_version: u32,
    fingerprint: String,
    folder: &'a str,
    /// The prefix of the names of all modules.
    #[serde(skip_serializing_if = "str::is_empty")]
    prefix: &'a str,
    files: Vec<&'a str>,
    benches: Vec<BenchListing<'a>>,
}

/// The vectors of a bench: their length, and the regions in them by their state.
#[derive(Serialize)]
struct BenchListing<'a> {
    top: &'static str,
    grid: (u32, u32),
    clocks: u64,
    frames: u64,
    active: u64,
    held: u64,
    blank: u64,
    /// The number of blank regions that send a summary. It is left out if irrelevant regions send
    /// none.
    #[serde(skip_serializing_if = "Option::is_none")]
    summaries: Option<u64>,
    compared: u64,
    shortcoming: Option<&'a str>,
}

pub(crate) fn run(args: &GenerateArgs) -> Result<(), CliError> {
    StagedFolder::check(&args.output, CORE, args.force)?;
    let design = args.design.design()?;
    let prefix = Prefix::from_request(args.prefix.as_deref(), &design)?;
    let cancel = interrupt::stop_flag()?;
    let core = write_core(&design, &prefix, &args.output, args.force, &cancel)?;
    core.warnings().for_each(|warning| notice::print_warning(&warning));
    let shown = args.output.display().to_string();
    if args.json {
        return output::print_json(&CoreListing {
            format_version: 1,
            fingerprint: design.fingerprint(),
            folder: &shown,
            prefix: prefix.text(),
            files: core.files.iter().map(String::as_str).collect(),
            benches: core.benches.iter().map(|bench| bench_listing(&design, bench)).collect(),
        });
    }
    if args.quiet {
        return Ok(());
    }
    let named = match prefix.text() {
        "" => String::new(),
        text => format!(", prefix {text}"),
    };
    output::print_text(&format!(
        "{shown}: {} files for {} regions of {size}x{size} pixels, design {}{named}; start with README.md\n",
        core.files.len(),
        design.regions(),
        design.fingerprint(),
        size = design.region_size(),
    ))
}

fn bench_listing<'a>(design: &Design, bench: &'a ShippedBench) -> BenchListing<'a> {
    let tally = &bench.tally;
    BenchListing {
        top: bench.top.module(),
        grid: bench.grid,
        clocks: bench.clocks,
        frames: tally.frames,
        active: tally.active,
        held: tally.held,
        blank: tally.blank,
        summaries: design.periphery().map(|_| tally.summaries),
        compared: tally.compared,
        shortcoming: bench.shortcoming.as_deref(),
    }
}
