// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of a core beside its Verilog: file lists, FuseSoC, constraints, Vivado, the benches' script.
//! Its README is in [`crate::readme`].

use crate::organization::Emitter;
use crate::text::text_of;
use crate::{SourceFile, Top, banner, verilog};
use askama::Template;
use foveate_design::Design;

#[derive(Template)]
#[template(path = "fusesoc.core")]
struct FuseSoc<'a> {
    banner: String,
    version: &'static str,
    columns: u32,
    rows: u32,
    n: u32,
    files: Vec<&'a str>,
}

#[derive(Template)]
#[template(path = "replay.sh")]
struct Replay {
    banner: String,
    simulator: &'static str,
}

/// Clocks of a frame, of all lanes, from which a bench is slower in Icarus than Verilator takes to compile it.
const ICARUS_CLOCKS: u64 = 40_000;

/// Every file of the core of `design` but its benches and its timing diagram, which come from the model.
#[must_use]
pub fn core(design: &Design) -> Vec<SourceFile> {
    let mut files = verilog(design, Top::Rcm);
    let rcm_list = file_list(&files);
    let unit = verilog(design, Top::Rpu);
    let unit_list = file_list(&unit);
    // A serial array has no RPU inside.
    files.extend(unit.into_iter().filter(|file| !rcm_list.contains(&file.path)));
    let paths: Vec<_> = files.iter().map(|file| file.path.as_str()).collect();
    let beside = [
        ("rpu.f", unit_list),
        ("rcm.f", rcm_list),
        ("foveate_rcm.core", text_of(&fusesoc(design, paths))),
        ("constraints/ooc.xdc", include_str!("../../../constraints/ooc.xdc").to_owned()),
        ("vivado_ooc.tcl", include_str!("../../../scripts/vivado_ooc.tcl").to_owned()),
        ("design.toml", design_toml(design)),
        ("tb/replay.sh", text_of(&replay(design))),
        ("README.md", (Emitter::of(design).readme)(design)),
    ];
    files.extend(beside.map(|(path, contents)| SourceFile { path: path.to_owned(), contents }));
    files
}

fn replay(design: &Design) -> Replay {
    let unit = design.unit();
    // Of an array of copies the bench simulates a few.
    let lanes = if unit.rpu_in_rcm { 1 } else { u64::from(unit.count) };
    let is_long = design.timing().clocks_per_frame().saturating_mul(lanes) > ICARUS_CLOCKS;
    Replay { banner: banner(design), simulator: if is_long { "verilator" } else { "iverilog" } }
}

fn file_list(files: &[SourceFile]) -> String {
    files.iter().map(|file| format!("{}\n", file.path)).collect()
}

fn design_toml(design: &Design) -> String {
    format!("# {}\n\n{}", banner(design), design.config().to_toml())
}

fn fusesoc<'a>(design: &Design, files: Vec<&'a str>) -> FuseSoc<'a> {
    FuseSoc {
        banner: banner(design),
        version: env!("CARGO_PKG_VERSION"),
        columns: design.columns(),
        rows: design.rows(),
        n: design.region_size(),
        files,
    }
}
