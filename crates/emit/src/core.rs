// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of a core beside its Verilog: file lists, FuseSoC, constraints, Vivado, README.

use crate::organization::Emitter;
use crate::verilog::text_of;
use crate::{SourceFile, Top, banner, latency, verilog};
use askama::Template;
use foveate_design::{
    Design, Direction, Feed, MemoryKind, PipelinedTiming, Port, PortRole, SerialTiming, Thresholds,
};

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
#[template(path = "README.md")]
struct Readme {
    banner: String,
    width: u32,
    height: u32,
    p: u32,
    n: u32,
    columns: u32,
    rows: u32,
    regions: u32,
    scores: String,
    combine: &'static str,
    reference: &'static str,
    neighborhood: &'static str,
    filter: &'static str,
    stream_side: u32,
    stream_pixels: u32,
    halo: u32,
    latency: String,
    forward: &'static str,
    border: bool,
    runtime: bool,
    rcm_ports: Vec<PortRow>,
    thresholds: Vec<ThresholdRow>,
}

#[derive(Template)]
#[template(path = "serial_README.md")]
struct SerialReadme {
    banner: String,
    width: u32,
    height: u32,
    p: u32,
    n: u32,
    columns: u32,
    rows: u32,
    regions: u32,
    lanes: u32,
    fold: u32,
    scores: String,
    combine: &'static str,
    reference: &'static str,
    neighborhood: &'static str,
    filter: &'static str,
    feed: &'static str,
    raster: bool,
    halo: u32,
    stream_side: u32,
    depth: u64,
    memory: &'static str,
    load_pixels: u64,
    load_clocks: u64,
    steps: u64,
    clocks: u64,
    runtime: bool,
    rcm_ports: Vec<PortRow>,
    thresholds: Vec<ThresholdRow>,
}

struct PortRow {
    name: String,
    direction: &'static str,
    bits: String,
    doc: String,
}

struct ThresholdRow {
    name: String,
    value: u64,
}

/// Every file of the core of `design` but its replay bench, whose vectors come from the model.
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
        ("README.md", (Emitter::of(design).readme)(design)),
    ];
    files.extend(beside.map(|(path, contents)| SourceFile { path: path.to_owned(), contents }));
    files
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

pub(crate) fn pipelined_readme(design: &Design) -> String {
    text_of(&pipelined_view(design, PipelinedTiming::of(design)))
}

pub(crate) fn serial_readme(design: &Design) -> String {
    text_of(&serial_view(design, &SerialTiming::of(design)))
}

fn score_names(design: &Design) -> String {
    let names: Vec<_> = design.features().iter().map(|f| f.kind().name()).collect();
    names.join(", ")
}

fn serial_view(design: &Design, timing: &SerialTiming) -> SerialReadme {
    let memory = design.lane_memory();
    SerialReadme {
        banner: banner(design),
        width: design.width(),
        height: design.height(),
        p: design.pixel_bits(),
        n: design.region_size(),
        columns: design.columns(),
        rows: design.rows(),
        regions: design.regions(),
        lanes: design.lanes(),
        fold: design.fold(),
        scores: score_names(design),
        combine: design.combine().name(),
        reference: design.temporal().reference.name(),
        neighborhood: design.neighborhood().name(),
        filter: design.filter().name(),
        feed: design.feed().name(),
        raster: design.feed() == Feed::Raster,
        halo: design.halo(),
        stream_side: design.stream_side(),
        depth: memory.depth,
        memory: match memory.kind {
            MemoryKind::Distributed => "distributed RAM",
            MemoryKind::Block => "block RAM",
        },
        load_pixels: timing.load_pixels(),
        load_clocks: timing.load_clocks(),
        steps: timing.steps(),
        clocks: timing.clocks_per_frame(),
        runtime: design.thresholds() == Thresholds::Runtime,
        rcm_ports: design.rcm_ports().iter().map(port_row).collect(),
        thresholds: design.rpu_ports().iter().filter_map(|port| threshold(design, port)).collect(),
    }
}

fn pipelined_view(design: &Design, timing: PipelinedTiming) -> Readme {
    Readme {
        banner: banner(design),
        width: design.width(),
        height: design.height(),
        p: design.pixel_bits(),
        n: design.region_size(),
        columns: design.columns(),
        rows: design.rows(),
        regions: design.regions(),
        scores: score_names(design),
        combine: design.combine().name(),
        reference: design.temporal().reference.name(),
        neighborhood: design.neighborhood().name(),
        filter: design.filter().name(),
        stream_side: design.stream_side(),
        stream_pixels: design.stream_pixels(),
        halo: design.halo(),
        latency: latency(design),
        forward: if timing.forward_frames == 1 {
            "the next frame"
        } else {
            "the next frame but one"
        },
        border: design.needs_border(),
        runtime: design.thresholds() == Thresholds::Runtime,
        rcm_ports: design.rcm_ports().iter().map(port_row).collect(),
        thresholds: design.rpu_ports().iter().filter_map(|port| threshold(design, port)).collect(),
    }
}

fn port_row(port: &Port) -> PortRow {
    PortRow {
        name: port.name.clone(),
        direction: match port.direction {
            Direction::Input => "in",
            Direction::Output => "out",
        },
        bits: match port.lanes {
            1 => port.width.to_string(),
            lanes => format!("{lanes} x {}", port.width),
        },
        doc: port.doc.clone(),
    }
}

/// The configured value of a threshold input.
fn threshold(design: &Design, port: &Port) -> Option<ThresholdRow> {
    let feature = |kind| design.feature(kind);
    let value = match port.role {
        PortRole::Level(kind) => feature(kind)?.level()?.into(),
        PortRole::MinScore(kind) => feature(kind)?.min_score(),
        PortRole::TemporalLevel => design.temporal().level.into(),
        PortRole::TemporalMinCount => design.temporal().min_count.into(),
        _ => return None,
    };
    Some(ThresholdRow { name: port.name.clone(), value })
}
