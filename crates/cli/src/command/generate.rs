// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate generate`: the core of a design as a folder.

use foveate_cosim::{Stimulus, replay_bench, vectors_hex};
use foveate_emit::{SourceFile, Top};
use foveate_spec::{Design, Organization};
use foveate_staging::{Kind, StagedFolder};
use serde::Serialize;

use crate::args::GenerateArgs;
use crate::error::CliError;
use crate::{interrupt, output};

/// What is written, and what may be replaced.
const CORE: Kind = Kind {
    what: "a generated core (its foveate_rcm.core)",
    is: |folder| folder.join("foveate_rcm.core").is_file(),
};
/// Clocks of the bench that comes with a core: enough for several frames of each kind at 8x8, small
/// enough to be kept under version control.
const BENCH_CLOCKS: u64 = 2000;

#[derive(Serialize)]
struct Listing<'a> {
    format_version: u32,
    fingerprint: String,
    folder: &'a str,
    files: Vec<&'a str>,
}

pub(crate) fn run(args: &GenerateArgs) -> Result<(), CliError> {
    let design = args.design.design()?;
    let folder = StagedFolder::new(&args.output, CORE, args.force)?;
    let files = files(&design)?;
    for file in &files {
        folder.write(&file.path, file.contents.as_bytes())?;
    }
    folder.commit()?;
    let shown = args.output.display().to_string();
    if args.json {
        return output::json(&Listing {
            format_version: 1,
            fingerprint: design.fingerprint(),
            folder: &shown,
            files: files.iter().map(|file| file.path.as_str()).collect(),
        });
    }
    output::text(&format!(
        "{shown}: {} files for {} regions of {size}x{size} pixels, design {}; start with README.md\n",
        files.len(),
        design.regions(),
        design.fingerprint(),
        size = design.region_size(),
    ))
}

/// The core and, where there is a model to compare with at every clock, its replay bench with vectors
/// from that.
fn files(design: &Design) -> Result<Vec<SourceFile>, CliError> {
    let mut files = foveate_emit::core(design);
    match design.organization() {
        Organization::Pipelined => {}
        Organization::Serial => return Ok(files),
    }
    let stimulus = Stimulus { rounds: 1, ..Stimulus::default() };
    let cancel = interrupt::flag()?;
    let recording = stimulus.record_until(design, &cancel, &mut |_, _| {})?;
    let rpu = Top::Rpu;
    let mut add = |path: &str, contents| files.push(SourceFile { path: path.to_owned(), contents });
    add("tb/rpu_replay.v", replay_bench(rpu.module(), &rpu.ports(design), &rpu.parameters(design)));
    add("tb/rpu_vectors.hex", vectors_hex(&recording, BENCH_CLOCKS)?);
    Ok(files)
}
