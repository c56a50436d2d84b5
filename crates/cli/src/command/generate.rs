// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate generate`: the core of a design as a folder.

use foveate_cosim::{ShippedBench, timing_diagram};
use foveate_design::Design;
use foveate_emit::Top;
use foveate_staging::{Kind, StagedFolder};
use serde::Serialize;
use std::sync::atomic::AtomicBool;

use crate::args::GenerateArgs;
use crate::error::CliError;
use crate::{interrupt, output};

/// What is written, and what may be replaced.
const CORE: Kind = Kind {
    what: "a generated core (its foveate_rcm.core)",
    is: |folder| folder.join("foveate_rcm.core").is_file(),
    listed: true,
};

#[derive(Serialize)]
struct Listing<'a> {
    format_version: u32,
    fingerprint: String,
    folder: &'a str,
    files: Vec<&'a str>,
    benches: Vec<BenchListing<'a>>,
}

/// What the vectors of a bench show.
#[derive(Serialize)]
struct BenchListing<'a> {
    top: &'static str,
    grid: (u32, u32),
    clocks: u64,
    frames: u64,
    active: u64,
    held: u64,
    blank: u64,
    compared: u64,
    shortcoming: Option<&'a str>,
}

pub(crate) fn run(args: &GenerateArgs) -> Result<(), CliError> {
    let design = args.design.design()?;
    let folder = StagedFolder::new(&args.output, CORE, args.force)?;
    let mut files = foveate_emit::core(&design);
    let cancel = interrupt::flag()?;
    let benches = benches(&design, &cancel)?;
    files.extend(benches.iter().flat_map(|bench| bench.files.iter().cloned()));
    files.extend(timing_diagram(&design, &cancel)?);
    for file in &files {
        folder.write(&file.path, file.contents.as_bytes())?;
    }
    folder.commit()?;
    let shown = args.output.display().to_string();
    warn(&benches);
    if args.json {
        return output::json(&Listing {
            format_version: 1,
            fingerprint: design.fingerprint(),
            folder: &shown,
            files: files.iter().map(|file| file.path.as_str()).collect(),
            benches: benches.iter().map(listing).collect(),
        });
    }
    if args.quiet {
        return Ok(());
    }
    output::text(&format!(
        "{shown}: {} files for {} regions of {size}x{size} pixels, design {}; start with README.md\n",
        files.len(),
        design.regions(),
        design.fingerprint(),
        size = design.region_size(),
    ))
}

/// The bench of one RPU or lane, and that of the array.
fn benches(design: &Design, cancel: &AtomicBool) -> Result<Vec<ShippedBench>, CliError> {
    let bench = |top| Ok(ShippedBench::new(design, top, cancel)?);
    [Top::Rpu, Top::Rcm].into_iter().map(bench).collect()
}

/// Says which benches will not pass, and why.
fn warn(benches: &[ShippedBench]) {
    for bench in benches {
        if let Some(shortcoming) = &bench.shortcoming {
            eprintln!(
                "warning: tb/{0}_replay.v does not test all of `{0}`, so it never says PASS: {shortcoming}",
                bench.top.module()
            );
        }
    }
}

fn listing(bench: &ShippedBench) -> BenchListing<'_> {
    let tally = &bench.tally;
    BenchListing {
        top: bench.top.module(),
        grid: bench.grid,
        clocks: bench.clocks,
        frames: tally.frames,
        active: tally.active,
        held: tally.held,
        blank: tally.blank,
        compared: tally.compared,
        shortcoming: bench.shortcoming.as_deref(),
    }
}
