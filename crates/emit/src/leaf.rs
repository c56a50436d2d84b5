// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hand-written leaf modules of cores and boards, and which of them a design needs.

use foveate_camera::{DenoiseFilter, FeatureKind, Neighborhood, ReferencePolicy};
use foveate_design::{Design, Pipelining};

/// A hand-written module of `rtl/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// The name of the module and, with `.v`, of its file.
    pub name: &'static str,
    /// The text of the module.
    pub contents: &'static str,
    /// The leaves that the module instantiates, in any branch of a `generate`.
    pub uses: &'static [&'static str],
}

macro_rules! leaves {
    ($of:ident: $($name:literal => [$($uses:literal),* $(,)?]),+ $(,)?) => {
        &[$(Leaf { name: $name, contents: text!($of, $name), uses: &[$($uses),*] }),+]
    };
}

macro_rules! text {
    (cores, $name:literal) => {
        include_str!(concat!("../rtl/", $name, ".v"))
    };
    (boards, $name:literal) => {
        include_str!(concat!("../rtl/board/", $name, ".v"))
    };
}

/// The leaves around a core on a board, each after those that it instantiates; `packet_crc` is in
/// [`LEAVES`].
pub const BOARD_LEAVES: &[Leaf] = leaves! {
    boards:
    "clock_crossing" => [],
    "dvp_capture" => ["clock_crossing"],
    "i2c_setup" => [],
    "pattern_source" => [],
    "packet_signature" => [],
    "packet_sample" => [],
    "packet_bytes" => [],
    "array_pattern" => [],
    "array_turn" => [],
    "array_signature" => ["packet_crc"],
    "array_snapshot" => [],
    "uart_sender" => [],
    "uart_receiver" => [],
    "uart_registers" => ["packet_crc"],
};

/// All leaves of cores, each after those that it instantiates.
pub const LEAVES: &[Leaf] = leaves! {
    cores:
    "frame_sync" => [],
    "line_delay" => [],
    "window_isolated" => [],
    "window_shared" => [],
    "window_column" => ["line_delay"],
    "median3x3" => [],
    "adder" => [],
    "carry_adder" => [],
    "binomial3x3" => ["adder", "carry_adder"],
    "magnitude_above" => [],
    "edge_detector" => ["adder", "magnitude_above"],
    "corner_detector" => [],
    "position_counter" => [],
    "frame_progress" => [],
    "frame_store" => [],
    "last_sent" => ["frame_store"],
    "deep_last_sent" => [],
    "change_detector" => ["magnitude_above"],
    "hit_counter" => [],
    "candidate_count" => [],
    "region_class" => [],
    "region_sum" => [],
    "region_mean" => [],
    "deviation_sum" => [],
    "segment_score" => ["magnitude_above"],
    "variance_score" => [],
    "region_range" => [],
    "region_surface" => ["carry_adder"],
    "block_place" => [],
    "block_mean" => ["block_place", "adder", "line_delay"],
    "region_summary" => ["block_mean", "line_delay", "magnitude_above"],
    "score_hold" => [],
    "vote" => [],
    "decision" => [],
    "forward_gate" => [],
    "serial_memory" => ["frame_store"],
    "serial_lane" => ["serial_memory", "carry_adder"],
    "serial_control" => [],
    "serial_group" => ["serial_control"],
    "serial_states" => [],
    "serial_regions" => [],
    "serial_addresses" => [],
    "serial_constant" => [],
    "serial_controls" => [],
    "serial_flow" => [],
    "serial_sequencer" => [
        "serial_states", "serial_regions", "serial_flow", "serial_addresses", "serial_constant",
        "serial_controls",
    ],
    "serial_parallel_feed" => [],
    "serial_places" => [],
    "serial_neighbor" => [],
    "serial_raster_feed" => ["serial_places", "serial_neighbor"],
    "serial_shown" => [],
    "serial_sides" => [],
    "class_memory" => [],
    "serial_decision" => ["frame_store"],
    "serial_means" => [],
    "serial_summary" => ["serial_means", "frame_store", "magnitude_above"],
    "raster_memory" => [],
    "word_delay" => [],
    "bit_delay" => [],
    "raster_ring" => [],
    "raster_pad" => [],
    "raster_control" => [],
    "raster_window" => ["raster_memory"],
    "raster_line" => ["raster_memory", "raster_ring"],
    "median_columns" => ["word_delay"],
    "binomial_columns" => ["word_delay", "carry_adder"],
    "raster_edge" => ["adder", "magnitude_above"],
    "raster_corner" => [],
    "raster_change" => ["magnitude_above"],
    "raster_counts" => ["raster_memory", "word_delay", "bit_delay"],
    "raster_pairs" => ["raster_ring", "word_delay", "bit_delay"],
    "raster_banks" => ["raster_memory", "word_delay", "bit_delay"],
    "raster_store" => ["raster_memory", "raster_ring", "raster_pairs", "raster_banks"],
    "raster_external" => ["word_delay"],
    "raster_start" => [],
    "raster_valid" => ["word_delay"],
    "raster_walk" => [],
    "raster_repeat" => ["raster_memory"],
    "raster_sums" => ["raster_memory", "word_delay", "bit_delay"],
    "raster_variance" => [],
    "raster_range" => ["raster_memory", "word_delay", "bit_delay"],
    "raster_displacement" => ["word_delay"],
    "raster_surface" => ["raster_sums"],
    "raster_queue" => ["raster_memory"],
    "raster_segment" => ["word_delay"],
    "raster_pass" => ["raster_queue", "raster_walk", "word_delay", "bit_delay", "raster_segment"],
    "raster_readout" => ["raster_queue", "raster_walk"],
    "raster_moments" => ["raster_sums", "raster_variance"],
    "raster_deviation" => ["region_mean", "word_delay", "bit_delay", "raster_start", "raster_pass", "raster_memory"],
    "raster_parts" => [],
    "raster_blocks" => ["raster_parts"],
    "raster_summary" => [
        "raster_blocks", "adder", "magnitude_above", "raster_memory", "word_delay", "bit_delay"
    ],
    "raster_classes" => ["class_memory", "word_delay"],
    "raster_decision" => ["vote", "word_delay", "bit_delay", "raster_valid"],
    "raster_forward" => ["raster_start", "raster_readout", "raster_memory", "word_delay", "bit_delay"],
    "raster_core" => [
        "raster_control", "raster_pad", "bit_delay", "word_delay", "raster_window", "median_columns",
        "binomial_columns",
        "raster_edge", "raster_corner", "raster_displacement", "raster_store", "raster_external", "raster_change", "raster_counts",
        "raster_moments", "raster_range", "raster_surface", "raster_ring", "raster_deviation", "raster_decision",
        "raster_forward", "raster_line", "raster_repeat", "raster_summary", "raster_classes"
    ],
    "packet_crc" => [],
    "packet_place" => [],
    "packet_rows" => ["raster_memory"],
    "packet_regions" => ["packet_place", "raster_memory"],
    "packet_frames" => [],
    "packet_writer" => ["packet_crc"],
    "axi_video" => ["raster_memory"],
    "serial_array" => [
        "serial_raster_feed", "serial_parallel_feed", "serial_sequencer", "serial_shown",
        "serial_group", "serial_sides", "serial_lane", "serial_decision", "serial_summary",
        "class_memory"
    ],
};

/// Returns the leaf of a pipelined `rpu.v` that denoises, if there is one.
pub(crate) fn filter_leaf(filter: DenoiseFilter, deep: bool) -> Option<&'static str> {
    match (filter, deep) {
        (DenoiseFilter::None, _) => None,
        (DenoiseFilter::Median3x3 | DenoiseFilter::Switching3x3, false) => Some("median3x3"),
        (DenoiseFilter::Median3x3 | DenoiseFilter::Switching3x3, true) => Some("median_columns"),
        (DenoiseFilter::Binomial3x3, false) => Some("binomial3x3"),
        (DenoiseFilter::Binomial3x3, true) => Some("binomial_columns"),
    }
}

/// Returns the leaves that a pipelined `rpu.v` instantiates directly.
pub(crate) fn pipelined_leaves(design: &Design) -> Vec<&'static str> {
    let mut names =
        vec!["frame_progress", "frame_store", "hit_counter", "vote", "decision", "forward_gate"];
    let mut need = |condition: bool, leaves: &[&'static str]| {
        if condition {
            names.extend(leaves);
        }
    };
    let window = design.has_feature_window();
    let deep = design.pipelining() == Pipelining::Deep;
    need(true, &[if deep { "magnitude_above" } else { "change_detector" }]);
    let filter = filter_leaf(design.filter(), deep);
    need(filter.is_some(), filter.as_slice());
    need(filter.is_some() && deep, &["bit_delay"]);
    need(design.has_separate_raw_pixels(), &["line_delay"]);
    if filter.is_some() || window {
        need(true, &["window_column"]);
        match design.neighborhood() {
            Neighborhood::Isolated => need(true, &["window_isolated"]),
            Neighborhood::Shared => need(true, &["window_shared"]),
        }
    }
    need(!window, &["position_counter"]);
    need(design.zones().is_some(), &["region_class"]);
    need(design.periphery().is_some(), &["region_summary"]);
    for feature in design.features() {
        match feature.kind() {
            FeatureKind::Edge => need(true, &["edge_detector"]),
            FeatureKind::Corner => need(true, &["corner_detector"]),
            FeatureKind::Mad => {
                need(true, &["region_sum", "region_mean", "deviation_sum", "score_hold"]);
            }
            FeatureKind::Segment => {
                need(true, &["region_sum", "region_mean", "segment_score", "score_hold"]);
            }
            FeatureKind::Variance => need(true, &["region_sum", "variance_score"]),
            FeatureKind::Range => need(true, &["region_range"]),
            FeatureKind::Surface => need(true, &["region_surface"]),
            FeatureKind::Flow => unreachable!("pipelined refuses flow"),
        }
    }
    match design.temporal().reference {
        ReferencePolicy::Previous => {}
        ReferencePolicy::LastSent => {
            need(true, &[if deep { "deep_last_sent" } else { "last_sent" }]);
            need(design.has_second_pass(), &["candidate_count"]);
        }
    }
    names
}
