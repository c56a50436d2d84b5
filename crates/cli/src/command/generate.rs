// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate generate`: the core of a design as a folder.

use foveate_bench::random_frames;
use foveate_cosim::{Level, Stimulus, replay_bench, vectors_hex};
use foveate_design::Design;
use foveate_emit::{SourceFile, Top};
use foveate_simulator::SimulatorError;
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
/// Clocks of the bench that comes with a pipelined core: enough for several frames of each kind at 8x8, small
/// enough to be kept under version control.
const BENCH_CLOCKS: u64 = 2000;
/// Frames of the bench of a serial core, each of thousands of clocks. The second is the first again, so that
/// nothing of it is sent.
const SERIAL_FRAMES: u64 = 3;
/// Clocks of that bench at which it has fewer frames, but one at least.
const SERIAL_CLOCKS: u64 = 100_000;
/// Clocks of that bench at most; a frame of very large regions is longer.
const SERIAL_LIMIT: u64 = 250_000;

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

/// The core, and its replay bench with vectors from the model.
fn files(design: &Design) -> Result<Vec<SourceFile>, CliError> {
    let mut files = foveate_emit::core(design);
    let lane = Level::Rpu.design(design)?;
    let (stimulus, clocks) = stimulus(&lane)?;
    let cancel = interrupt::flag()?;
    let recording = stimulus.record_until(&lane, &cancel, &mut |_, _| {})?;
    let rpu = Top::Rpu;
    let mut add = |path: &str, contents| files.push(SourceFile { path: path.to_owned(), contents });
    add("tb/rpu_replay.v", replay_bench(rpu.module(), &rpu.ports(&lane), &rpu.parameters(&lane)));
    add("tb/rpu_vectors.hex", vectors_hex(&recording, clocks)?);
    Ok(files)
}

/// What the bench of an RPU or lane replays, and for how many clocks.
fn stimulus(lane: &Design) -> Result<(Stimulus, u64), CliError> {
    let timing = lane.timing();
    if timing.phases().is_empty() {
        return Ok((Stimulus { rounds: 1, ..Stimulus::default() }, BENCH_CLOCKS));
    }
    let count = (SERIAL_CLOCKS / timing.clocks_per_frame()).clamp(1, SERIAL_FRAMES);
    let mut frames = random_frames(lane, 1, 2).map_err(SimulatorError::from)?;
    frames.insert(1, frames[0].clone());
    frames.truncate(usize::try_from(count).unwrap_or(1));
    Ok((Stimulus { rounds: 0, frames, ..Stimulus::default() }, SERIAL_LIMIT))
}
