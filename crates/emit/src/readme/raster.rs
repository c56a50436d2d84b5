// SPDX-License-Identifier: MIT OR Apache-2.0
//! The README of a raster core, which says how long a source waits and when a region is lost.

use super::{
    PortRow, StreamRow, ThresholdRow, port_rows, score_names, stream_rows, sync, threshold_row,
};
use crate::verilog_text::{instance, rendered_text};
use crate::{Prefix, Top, banner};
use askama::Template;
use foveate_design::{
    FRAME_NUMBERS, FrameStoreKind, Pipelining, RasterDesign, RasterMemory, RasterTiming,
    ThresholdSource,
};

#[derive(Template)]
#[template(path = "raster_README.md")]
struct RasterReadme {
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
    word_pixels: u32,
    taken_words: u32,
    row_words: u32,
    /// The pixels of the last word of a row that are inside the frame; 0 if all are.
    tail_pixels: u32,
    /// The clocks after a row in which no word is taken.
    row_pause: u32,
    clocks: u64,
    /// The clocks after a frame in which no word is taken.
    stall: u64,
    blank_rows: u64,
    /// True if a frame waits until the one before has left.
    waits: bool,
    /// True if regions have classes.
    zones: bool,
    decided_after: u64,
    second_pass: bool,
    region_words: u32,
    first_word: u64,
    last_position: u32,
    frame_numbers: u32,
    /// True if regions have pixels outside the frame.
    padded: bool,
    buffer_rows: u32,
    sink_stall: u32,
    memories: Vec<RasterMemory>,
    memory_bits: u64,
    /// The number of words of references of a frame.
    store_words: u64,
    store_bits: u64,
    /// True if the references are outside the core.
    outside: bool,
    single_port: bool,
    /// True if pixels leave the core.
    forwards: bool,
    /// The number of blocks along a region's side whose means leave (0 if none do), and the side of
    /// a block in pixels.
    blocks: u32,
    block_side: u32,
    /// True if the core has more pipeline registers, which may be those of block RAM.
    deep: bool,
    /// True if memories record which regions have a reference.
    marks_regions: bool,
    store: &'static str,
    runtime: bool,
    streams: Vec<StreamRow>,
    rcm_ports: Vec<PortRow>,
    thresholds: Vec<ThresholdRow>,
    instance: Vec<String>,
    sync: String,
    /// The module whose clock frequency a user wants to know.
    synthesized: &'static str,
    compared: &'static str,
    has_rpu: bool,
    on_axi: bool,
}

pub(crate) fn raster_readme(design: RasterDesign<'_>, prefix: &Prefix) -> String {
    rendered_text(&view(design, prefix, &RasterTiming::from_design(design)))
}

fn view(design: RasterDesign<'_>, prefix: &Prefix, timing: &RasterTiming) -> RasterReadme {
    let n = design.region_size();
    let memories = RasterMemory::all_memories(design);
    let reference = design.temporal().reference;
    let reference_bits = reference.bits_per_pixel(design.pixel_bits());
    RasterReadme {
        banner: banner(&design),
        before: prefix.prefixed_name(""),
        width: design.width(),
        height: design.height(),
        p: design.pixel_bits(),
        n,
        columns: design.columns(),
        rows: design.rows(),
        regions: design.regions(),
        scores: score_names(&design),
        combine: design.combine().name(),
        reference: reference.name(),
        neighborhood: design.neighborhood().name(),
        filter: design.filter().name(),
        word_pixels: timing.word_pixels,
        taken_words: timing.taken_words,
        row_words: timing.row_words,
        tail_pixels: design.width() % timing.word_pixels,
        row_pause: timing.row_words - timing.taken_words,
        clocks: timing.clocks_per_frame(),
        stall: timing.edges_to_ready(),
        blank_rows: timing.blank_rows(),
        waits: timing.waits_for_pending,
        zones: design.zones().is_some(),
        decided_after: timing.clocks_to_decision(),
        second_pass: timing.second_pass.is_some(),
        region_words: timing.region_words,
        first_word: timing.clocks_to_first_word(),
        last_position: design.region_pixels() - timing.word_pixels,
        frame_numbers: FRAME_NUMBERS,
        padded: design.columns() * n > design.width() || design.rows() * n > design.height(),
        buffer_rows: timing.buffer_rows,
        sink_stall: timing.max_stall_clocks(),
        memory_bits: memories.iter().map(RasterMemory::total_bits).sum(),
        store_words: timing.words(),
        store_bits: timing.words() * u64::from(design.pixels_per_clock() * reference_bits),
        outside: design.store() == FrameStoreKind::External,
        single_port: design.store() == FrameStoreKind::SinglePort,
        forwards: design.has_forwarding(),
        blocks: design.periphery().map_or(0, |own| own.blocks),
        block_side: design.periphery().map_or(0, |own| own.block_side),
        memories,
        deep: design.pipelining() == Pipelining::Deep,
        marks_regions: reference.bits_per_region() > 0,
        store: design.store().name(),
        runtime: design.threshold_source() == ThresholdSource::Runtime,
        streams: stream_rows(&design),
        rcm_ports: port_rows(&design),
        thresholds: design
            .rcm_ports()
            .iter()
            .filter_map(|port| threshold_row(&design, port))
            .collect(),
        instance: instance(&design, prefix),
        synthesized: crate::top::placed_top(&design),
        sync: sync::sync_section(&design, "word", ""),
        has_rpu: Top::has_rpu(&design),
        on_axi: design.is_on_axi(),
        compared: " at which it is valid",
    }
}
