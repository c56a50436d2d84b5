// SPDX-License-Identifier: MIT OR Apache-2.0
//! The README of a core, with one template for each organization.

mod raster;
mod sync;

pub(crate) use raster::raster_readme;

use super::camera_flags::threshold_value;
use super::verilog_text::instance;
use crate::verilog_text::rendered_text;
use crate::{Prefix, Top, banner, latency_text};
use askama::Template;
use foveate_design::{
    CoreStream, Design, LaneMemoryKind, PipelinedDesign, PipelinedTiming, PixelFeed, Port,
    PortDirection, SerialDesign, SerialTiming, ThresholdSource,
};

#[derive(Template)]
#[template(path = "README.md")]
struct PipelinedReadme {
    banner: String,
    /// The beginning of the names of modules: the prefix and its `_`.
    before: String,
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
    clocks: u64,
    halo: u32,
    latency: String,
    forward: &'static str,
    sync: String,
    border: bool,
    runtime: bool,
    streams: Vec<StreamRow>,
    rcm_ports: Vec<PortRow>,
    thresholds: Vec<ThresholdRow>,
    instance: Vec<String>,
    /// The module whose clock frequency a user wants to know.
    synthesized: &'static str,
    /// The condition under which the bench for `rpu` compares an output, as words after "at every
    /// clock".
    compared: &'static str,
    has_rpu: bool,
    on_axi: bool,
}

#[derive(Template)]
#[template(path = "serial_README.md")]
struct SerialReadme {
    banner: String,
    /// The beginning of the names of modules: the prefix and its `_`.
    before: String,
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
    /// The clocks after the last pixel of a frame in which no pixel is taken.
    stall: u64,
    /// The clocks by which the last pixel leaves after `ready_o` is 1 again.
    behind: u32,
    pauses: u64,
    /// True if regions have classes.
    zones: bool,
    longest_pause: u32,
    empty: u32,
    sync: String,
    stream_pixels: u32,
    runtime: bool,
    streams: Vec<StreamRow>,
    rcm_ports: Vec<PortRow>,
    thresholds: Vec<ThresholdRow>,
    instance: Vec<String>,
    /// The module whose clock frequency a user wants to know.
    synthesized: &'static str,
    /// The condition under which the bench for `rpu` compares an output, as words after "at every
    /// clock".
    compared: &'static str,
    has_rpu: bool,
    on_axi: bool,
}

/// A stream of the core, as a row of a table.
struct StreamRow {
    name: &'static str,
    direction: &'static str,
    beat: &'static str,
    /// The ports that say that a beat is valid, and that it is taken.
    handshake: String,
    /// The ports that mark first and last beats.
    marks: String,
}

struct PortRow {
    name: String,
    /// The stream that the port belongs to, or the purpose of the port.
    group: &'static str,
    direction: &'static str,
    bits: String,
    doc: String,
}

struct ThresholdRow {
    name: String,
    value: u64,
}

pub(crate) fn pipelined_readme(design: PipelinedDesign<'_>, prefix: &Prefix) -> String {
    rendered_text(&pipelined_view(design, prefix, PipelinedTiming::from_design(design)))
}

pub(crate) fn serial_readme(design: SerialDesign<'_>, prefix: &Prefix) -> String {
    rendered_text(&serial_view(design, prefix, &SerialTiming::from_design(design)))
}

fn score_names(design: &Design) -> String {
    let names: Vec<_> = design.features().iter().map(|f| f.kind().name()).collect();
    names.join(", ")
}

fn serial_view(design: SerialDesign<'_>, prefix: &Prefix, timing: &SerialTiming) -> SerialReadme {
    let memory = design.lane_memory();
    SerialReadme {
        banner: banner(&design),
        before: prefix.prefixed_name(""),
        width: design.width(),
        height: design.height(),
        p: design.pixel_bits(),
        n: design.region_size(),
        columns: design.columns(),
        rows: design.rows(),
        regions: design.regions(),
        lanes: design.lanes(),
        fold: design.fold(),
        scores: score_names(&design),
        combine: design.combine().name(),
        reference: design.temporal().reference.name(),
        neighborhood: design.neighborhood().name(),
        filter: design.filter().name(),
        feed: design.feed().name(),
        zones: design.zones().is_some(),
        raster: design.feed() == PixelFeed::Raster,
        halo: design.halo(),
        stream_side: design.stream_side(),
        depth: memory.depth,
        memory: match memory.kind {
            LaneMemoryKind::Distributed => "distributed RAM",
            LaneMemoryKind::Block => "block RAM",
        },
        load_pixels: timing.load_pixels(),
        load_clocks: timing.load_clocks(),
        steps: timing.steps(),
        clocks: timing.clocks_per_frame(),
        stall: timing.edges_to_ready(),
        behind: timing.read_latency().saturating_sub(1),
        pauses: timing.load_clocks() - timing.load_pixels(),
        longest_pause: longest_pause(design),
        empty: design.lanes() * design.fold() - design.regions(),
        sync: sync::sync_section(&design, "pixel", feed_unit(design)),
        stream_pixels: design.stream_pixels(),
        runtime: design.threshold_source() == ThresholdSource::Runtime,
        streams: stream_rows(&design),
        rcm_ports: port_rows(&design),
        thresholds: design
            .rpu_ports()
            .iter()
            .filter_map(|port| threshold_row(&design, port))
            .collect(),
        instance: instance(&design, prefix),
        synthesized: crate::top::placed_top(&design),
        has_rpu: Top::has_rpu(&design),
        on_axi: design.is_on_axi(),
        compared: " at which it is valid",
    }
}

/// Returns how many pixels of the feed come at an edge, as words after "pixel".
fn feed_unit(design: SerialDesign<'_>) -> &'static str {
    match design.feed() {
        PixelFeed::Parallel => " of every lane",
        PixelFeed::Raster => "",
    }
}

/// Returns the most clocks for which a raster feed waits after one pixel, because several regions
/// need this pixel.
fn longest_pause(design: SerialDesign<'_>) -> u32 {
    let side = design.region_size();
    let most = |places: &dyn Fn(u32) -> u32, regions: u32| {
        (0..regions * side).map(places).max().expect("a frame has pixels")
    };
    match design.feed() {
        PixelFeed::Parallel => 0,
        PixelFeed::Raster => {
            let columns = most(&|x| design.column_places(x), design.columns());
            columns * most(&|y| design.row_places(y), design.rows()) - 1
        }
    }
}

fn pipelined_view(
    design: PipelinedDesign<'_>,
    prefix: &Prefix,
    timing: PipelinedTiming,
) -> PipelinedReadme {
    PipelinedReadme {
        banner: banner(&design),
        before: prefix.prefixed_name(""),
        width: design.width(),
        height: design.height(),
        p: design.pixel_bits(),
        n: design.region_size(),
        columns: design.columns(),
        rows: design.rows(),
        regions: design.regions(),
        scores: score_names(&design),
        combine: design.combine().name(),
        reference: design.temporal().reference.name(),
        neighborhood: design.neighborhood().name(),
        filter: design.filter().name(),
        stream_side: design.stream_side(),
        stream_pixels: design.stream_pixels(),
        clocks: design.timing().clocks_per_frame(),
        halo: design.halo(),
        latency: latency_text(design),
        forward: if timing.forward_frames == 1 {
            "the next frame"
        } else {
            "the next frame but one"
        },
        sync: sync::sync_section(&design, "pixel", " of every region"),
        border: design.needs_border(),
        runtime: design.threshold_source() == ThresholdSource::Runtime,
        streams: stream_rows(&design),
        rcm_ports: port_rows(&design),
        thresholds: design
            .rpu_ports()
            .iter()
            .filter_map(|port| threshold_row(&design, port))
            .collect(),
        instance: instance(&design, prefix),
        synthesized: crate::top::placed_top(&design),
        has_rpu: Top::has_rpu(&design),
        on_axi: design.is_on_axi(),
        compared: "",
    }
}

fn stream_rows(design: &Design) -> Vec<StreamRow> {
    let ports = |ports: &[Option<&str>]| {
        let names: Vec<_> = ports.iter().flatten().map(|name| format!("`{name}`")).collect();
        names.join(", ")
    };
    let row = |stream: &CoreStream| {
        let name = |port: &Option<Port>| port.as_ref().map(|port| port.name.clone());
        let last = stream.payload.iter().find(|port| Some(port.role) == stream.last);
        let (ready, start) = (name(&stream.ready), name(&stream.start));
        StreamRow {
            name: stream.role.name(),
            direction: direction(stream.direction),
            beat: stream.beat,
            handshake: ports(&[Some(&stream.valid.name), ready.as_deref()]),
            marks: ports(&[start.as_deref(), last.map(|port| port.name.as_str())]),
        }
    };
    design.rcm_interface().streams.iter().map(row).collect()
}

fn port_rows(design: &Design) -> Vec<PortRow> {
    let interface = design.rcm_interface();
    let row = |port: &Port| PortRow {
        name: port.name.clone(),
        group: match interface.stream_with_port(port.role) {
            Some(stream) => stream.role.name(),
            None if interface.controls.contains(port) => "control",
            None => "",
        },
        direction: direction(port.direction),
        bits: match port.lanes {
            1 => port.width.to_string(),
            lanes => format!("{lanes} x {}", port.width),
        },
        doc: port.doc.clone(),
    };
    interface.ports().iter().map(row).collect()
}

fn direction(direction: PortDirection) -> &'static str {
    match direction {
        PortDirection::Input => "in",
        PortDirection::Output => "out",
    }
}

fn threshold_row(design: &Design, port: &Port) -> Option<ThresholdRow> {
    let value = threshold_value(design, port)?;
    Some(ThresholdRow { name: port.name.clone(), value })
}
