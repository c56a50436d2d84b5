// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate build`: a camera on a board, as a project and as a bitstream.

use std::fmt::Write as _;
use std::path::Path;

use foveate_boards::{Board, BoardProject, BuildResult, PROJECT_FOLDER, build, write_project};
use foveate_design::{DesignConfig, Preset};
use foveate_media::read_class_map;
use foveate_tools::StagedFolder;
use serde::Serialize;

use crate::args::BuildArgs;
use crate::error::CliError;
use crate::progress::Progress;
use crate::{interrupt, output};

#[derive(Serialize)]
struct BoardListing<'a> {
    name: &'a str,
    title: &'a str,
    page: &'a str,
    part: &'a str,
    sensor: &'a str,
    frame: (u32, u32),
    fps: f64,
}

#[derive(Serialize)]
struct BuildReport<'a> {
    format_version: u32,
    board: &'a str,
    fingerprint: String,
    folder: String,
    files: Vec<String>,
    #[serde(flatten)]
    built: Option<BuildResult>,
}

pub(crate) fn run(args: &BuildArgs) -> Result<(), CliError> {
    let (Some(name), Some(folder)) = (&args.board, &args.output) else {
        return list_boards(args.json);
    };
    StagedFolder::check(folder, PROJECT_FOLDER, args.force)?;
    let board = Board::find(name)?;
    let design = configuration(&board, args)?.validate()?;
    let project = BoardProject::new(board, design)?;
    let files = write_project(&project, folder, args.force)?;
    let built = if args.project || !project.is_open() {
        None
    } else {
        Some(build_bitstream(&project, folder, args)?)
    };
    let complaint = built.as_ref().filter(|built| !built.is_fast_enough()).map(|built| {
        format!(
            "the clocks that were reached are too slow, so `{}` may not work; try more --seeds",
            folder.join(&built.bitstream).display()
        )
    });
    let report = BuildReport {
        format_version: 1,
        board: &project.board.name,
        fingerprint: project.design.fingerprint(),
        folder: folder.display().to_string(),
        files,
        built,
    };
    output::print_result((args.json, args.quiet), &report, || {
        text(&project, folder, report.files.len(), report.built.as_ref())
    })?;
    complaint.map_or(Ok(()), |complaint| Err(CliError::Failed(complaint)))
}

/// Returns the configuration of the file, of the preset or of the board, with the changes of
/// `--set`.
fn configuration(board: &Board, args: &BuildArgs) -> Result<DesignConfig, CliError> {
    let text = match (&args.config, &args.preset) {
        (Some(file), _) => foveate_tools::read_settings(file)
            .map_err(CliError::io("read the configuration", file))?,
        (None, Some(name)) => Preset::find(name)?.toml.to_owned(),
        (None, None) => board.config()?.to_toml(),
    };
    let mut config = DesignConfig::from_toml_with(&text, &args.overrides)?;
    read_class_map(&mut config.camera, args.config.as_deref(), &args.overrides)?;
    Ok(config)
}

fn build_bitstream(
    project: &BoardProject,
    folder: &Path,
    args: &BuildArgs,
) -> Result<BuildResult, CliError> {
    let toolchain = interrupt::toolchain()?;
    let progress = Progress::new(args.quiet);
    progress.report_work("synthesizing, placing and packing");
    let built = build(project, folder, args.seeds, &toolchain);
    progress.finish();
    Ok(built?)
}

fn text(
    project: &BoardProject,
    folder: &Path,
    files: usize,
    built: Option<&BuildResult>,
) -> String {
    let (board, design) = (&project.board, &project.design);
    let mut text = format!(
        "{}: {files} files for {}, {} x {} pixels, design {}; start with README.md\n",
        folder.display(),
        board.name,
        design.width(),
        design.height(),
        design.fingerprint()
    );
    // Writing to a string cannot fail, so that the results of `writeln!` are ignored below.
    let Some(built) = built else {
        let make = if project.is_open() {
            "sh build.sh 5"
        } else {
            "vivado -mode batch -source build.tcl"
        };
        let _ = writeln!(text, "make the bitstream there: {make}");
        return text;
    };
    for cell in &built.used {
        let _ = writeln!(text, "{:24}{:>8} of {}", cell.cell, cell.used, cell.available);
    }
    let worst = built.reached_mhz.first().copied().unwrap_or(0.0);
    let _ = writeln!(
        text,
        "core    {:.1} MHz (slowest of {} seeds {worst:.1}), needs {}",
        built.packed_mhz,
        built.reached_mhz.len(),
        built.core_mhz
    );
    let _ = writeln!(text, "sensor  {:.1} MHz, needs {}", built.pclk_reached_mhz, built.pclk_mhz);
    let _ = writeln!(
        text,
        "frames  {:.0} per second arrive, {:.0} per second are possible",
        project.incoming_fps(),
        project.core_fps(f64::from(built.core_mhz))
    );
    let _ = writeln!(
        text,
        "load it: {}/{} ({} bytes): {}",
        folder.display(),
        built.bitstream,
        built.bytes,
        project.load_command()
    );
    text
}

fn list_boards(json: bool) -> Result<(), CliError> {
    let boards = Board::all().map(|board| {
        let design = board.config()?.validate()?;
        Ok(BoardProject::new(board, design)?)
    });
    let projects = boards.collect::<Result<Vec<_>, CliError>>()?;
    let listed: Vec<_> = projects.iter().map(board_listing).collect();
    if json {
        return output::print_json(&listed);
    }
    let mut text = String::new();
    for board in &listed {
        let (width, height) = board.frame;
        let _ = writeln!(
            text,
            "{:16}{}\n{:16}{}; {}, {width} x {height} pixels, {:.0} frames/s",
            board.name, board.title, "", board.part, board.sensor, board.fps
        );
    }
    text += "\nThe project simulates each of these designs as a whole, and places, routes and packs all but that of vcu118, which needs Vivado. None has been run on a real board.\n";
    output::print_text(&text)
}

fn board_listing(project: &BoardProject) -> BoardListing<'_> {
    let BoardProject { board, design, .. } = project;
    BoardListing {
        name: &board.name,
        title: &board.title,
        page: &board.page,
        part: &board.device.part,
        sensor: project.sensor_title(),
        frame: (design.width(), design.height()),
        fps: project.incoming_fps(),
    }
}
