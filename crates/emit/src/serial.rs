// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills `serial.v`, the top of a serial design: the array, or an array that has one lane.

use super::camera_flags::{
    ThresholdConstant, ThresholdSignal, filter_number, parameter_prefix, scores_text,
    summary_level_signal, threshold_constants, threshold_signal,
};
use super::class_map::{
    class_address_range, class_connections, class_parameters, class_summary_levels, first_map,
    keen_signal,
};
use super::top::{self, FrameSync};
use crate::camera_flags::{blanks_flag, last_sent_flag};
use crate::verilog_text::{PortLine, module_file, rendered_text};
use crate::{SourceFile, Top, banner};
use askama::Template;
use foveate_camera::{
    FeatureKind, Neighborhood, RegionClass, SpatialFeature, VoteCombination, bits_for,
};
use foveate_design::{
    FlowSearch, LaneMemoryKind, Pipelining, PixelFeed, Port, PortRole, SerialDesign, SerialTiming,
    SlotAreaKind, ThresholdSource,
};

#[derive(Template)]
#[template(path = "serial.v")]
struct SerialTop {
    banner: String,
    title: String,
    summary: String,
    memory: &'static str,
    clocks: String,
    module: &'static str,
    columns: u32,
    rows: u32,
    /// The most columns and rows of regions that the ports allow.
    widest: u32,
    highest: u32,
    ports: Vec<PortLine>,
    constants: Vec<ThresholdConstant>,
    /// The first map of classes, in a design with zones.
    first_map: Option<String>,
    parameters: Vec<(String, String)>,
    fold: u32,
    slot_bits: u32,
    center_bits: u32,
    position_bits: u32,
    raster: bool,
    /// The number of lanes, the number of slots and the ranges of their numbers, in terms of the
    /// grid.
    lanes: String,
    slots: String,
    slot_range: &'static str,
    region_range: &'static str,
    // Thresholds.
    half_level: bool,
    temporal_level: String,
    keen_temporal_level: String,
    /// The inputs of the array for the levels of features, and the signals connected to them.
    levels: Vec<(&'static str, String)>,
    /// The minima of the scores, that of the last feature first and that of the changed pixels
    /// last.
    minima: Vec<String>,
    keen_minima: Vec<String>,
    summary_level: String,
    keen_summary_level: String,
    off_summary_level: String,
    /// The ports of the memory of classes, and the signals connected to them.
    classes: [(&'static str, &'static str); 5],
    summarizes: bool,
    /// True if the ports have displacements.
    displaces: bool,
    sync: Option<FrameSync>,
    valid: &'static str,
    ready: &'static str,
}

/// The highest bit of the number of a region, in terms of the grid.
const REGION_RANGE: &str = "(COLUMNS*ROWS > 1 ? $clog2(COLUMNS*ROWS) : 1)-1";

/// Returns the top: the array, or the array that has one lane.
pub(crate) fn modules(design: SerialDesign<'_>, top: Top) -> Vec<SourceFile> {
    let lane = design.single_lane_design();
    let view = match top {
        Top::Rpu => view(lane.with_hardware(design.own_hardware()), design, top),
        Top::Rcm => view(design, design, top),
    };
    vec![module_file(top.module(), rendered_text(&view))]
}

/// Returns the range of a port whose width depends on the grid; `None` for other ports.
fn port_range(port: &Port, design: SerialDesign<'_>) -> Option<String> {
    match (port.role, port.per_lane, port.width) {
        (PortRole::ClassAddress, _, _) => Some(class_address_range()),
        (PortRole::Region | PortRole::ForwardRegion, _, _) => Some(format!("[{REGION_RANGE}:0]")),
        (_, true, 1) => Some(format!("[{}-1:0]", lane_count(design))),
        (_, true, width) => Some(format!("[{}*{width}-1:0]", lane_count(design))),
        (_, false, _) => None,
    }
}

/// Returns the number of lanes in terms of the grid.
fn lane_count(design: SerialDesign<'_>) -> String {
    match design.fold() {
        1 => "COLUMNS*ROWS".to_owned(),
        fold => format!("((COLUMNS*ROWS+{})/{fold})", fold - 1),
    }
}

/// Returns the number of beats of a frame in terms of the grid.
fn frame_beats(design: SerialDesign<'_>) -> String {
    match design.feed() {
        PixelFeed::Parallel => (design.fold() * design.stream_pixels()).to_string(),
        PixelFeed::Raster => format!("COLUMNS * ROWS * {}", design.region_pixels()),
    }
}

fn view(design: SerialDesign<'_>, named: SerialDesign<'_>, top: Top) -> SerialTop {
    let memory = design.lane_memory();
    let edge = design.feature(FeatureKind::Edge);
    let runtime = design.threshold_source() == ThresholdSource::Runtime;
    let [keen_summary_level, off_summary_level] = class_summary_levels(&design);
    SerialTop {
        banner: banner(&named),
        title: title(design, top),
        summary: scores_text(&design),
        memory: match memory.kind {
            LaneMemoryKind::Distributed => "distributed RAM",
            LaneMemoryKind::Block => "block RAM",
        },
        clocks: clocks_text(design),
        module: top.module(),
        columns: design.columns(),
        rows: design.rows(),
        // An array that has one lane may have more columns.
        widest: design.max_regions_per_line().max(design.columns()),
        highest: design.max_regions_per_line(),
        ports: PortLine::aligned(&top.ports(&named), |port| port_range(port, named)),
        constants: threshold_constants(&design)
            .into_iter()
            .filter(|c| !c.name.ends_with("EDGE_LEVEL"))
            .collect(),
        first_map: first_map(&design),
        parameters: array_parameters(design),
        fold: design.fold(),
        slot_bits: design.slot_bits(),
        center_bits: design.lane_widths().center,
        position_bits: design.position_bits(),
        raster: design.feed() == PixelFeed::Raster,
        lanes: lane_count(design),
        slots: format!("LANES*{}", design.fold()),
        slot_range: "(SLOTS > 1 ? $clog2(SLOTS) : 1)-1",
        region_range: REGION_RANGE,
        half_level: edge.is_some() && runtime,
        temporal_level: threshold_signal(&design, PortRole::TemporalLevel),
        keen_temporal_level: keen_signal(&design, PortRole::TemporalLevel),
        levels: FeatureKind::ALL.iter().flat_map(|&kind| level_inputs(design, kind)).collect(),
        minima: minima(design, threshold_signal),
        keen_minima: minima(design, keen_signal),
        summary_level: summary_level_signal(&design),
        keen_summary_level,
        off_summary_level,
        classes: class_connections(&design),
        summarizes: design.periphery().is_some(),
        displaces: design.flow_search().is_some(),
        sync: FrameSync::with_ready(&design, frame_beats(design)),
        valid: top::valid_signal(&design),
        ready: top::ready_signal(&design),
    }
}

fn title(design: SerialDesign<'_>, top: Top) -> String {
    let size = design.region_size();
    let p = design.pixel_bits();
    match top {
        Top::Rpu => format!(
            "One lane of the serial array by itself: {} regions of {size}x{size} {p}-bit pixels side by side.",
            design.fold()
        ),
        Top::Rcm => format!(
            "Relevance computation module: COLUMNS x ROWS regions of {size}x{size} {p}-bit pixels."
        ),
    }
}

fn clocks_text(design: SerialDesign<'_>) -> String {
    let timing = SerialTiming::from_design(design);
    format!(
        "{} clocks to take it and {} steps, with the grid above",
        timing.load_clocks(),
        timing.steps()
    )
}

fn array_parameters(design: SerialDesign<'_>) -> Vec<(String, String)> {
    let memory = design.lane_memory();
    let widths = design.lane_widths();
    let region = design.region_size();
    let base = |kind| memory.area(kind).map_or(0, |area| area.base);
    let fraction = design.second_pass_mean();
    let flag = |condition: bool| u32::from(condition);
    let numbers = [
        ("WIDTH", design.pixel_bits()),
        ("SIDE", region),
        ("RAW_SIDE", design.stream_side()),
        (
            "DENOISED_SIDE",
            if design.filter().has_window() { design.denoised_side() } else { region },
        ),
        ("FILTER", filter_number(design.filter())),
        ("SHARED", flag(design.neighborhood() == Neighborhood::Shared)),
        ("LAST_SENT", flag(last_sent_flag(&design))),
        ("BLANKS", flag(blanks_flag(&design))),
        ("RAW_PAYLOAD", flag(design.has_separate_raw_pixels())),
        ("RASTER", flag(design.feed() == PixelFeed::Raster)),
        ("BLOCK", flag(memory.kind == LaneMemoryKind::Block)),
        ("DEEP", flag(design.pipelining() == Pipelining::Deep)),
        ("FEATURES", design.score_count() - 1),
        ("ALL", flag(design.combine() == VoteCombination::All)),
        ("FRACTION", fraction.map_or(0, |mean| mean.fraction_bits)),
        ("DENOISED_BASE", base(SlotAreaKind::Denoised)),
        ("REFERENCE_BASE", base(SlotAreaKind::Reference)),
        ("WORD_BITS", memory.slot_words.trailing_zeros()),
        ("SLOT_BITS", design.slot_bits()),
        ("ADDRESS_BITS", memory.address_bits),
        ("POSITION_BITS", widths.center),
        ("INDEX_BITS", design.score_index_bits()),
        ("COUNT_BITS", design.count_bits()),
        ("SCORE_BITS", design.max_score_bits()),
        ("SUM_BITS", design.pixel_sum_bits()),
        ("SCALE_BITS", widths.scale),
        ("ACC_BITS", widths.accumulator),
        ("AUX_BITS", widths.second),
        ("CHAIN_BITS", widths.chain),
    ];
    let named = |(name, value): (&str, String)| (name.to_owned(), value);
    let mut list: Vec<_> =
        numbers.iter().map(|(name, value)| named((name, value.to_string()))).collect();
    list.extend(FeatureKind::ALL.iter().map(|&kind| score_index(design, kind)));
    list.extend(design.flow_search().iter().flat_map(flow_parameters).map(named));
    if let (Some(periphery), Some(sums)) = (design.periphery(), design.block_mean_division()) {
        let factor_bits = bits_for(sums.factor);
        let means = [
            ("BLOCKS", periphery.blocks.to_string()),
            ("MEAN_DROPPED", sums.dropped_bits.to_string()),
            ("MEAN_SUM_BITS", sums.passing_bits.to_string()),
            ("MEAN_FACTOR_BITS", factor_bits.to_string()),
            ("MEAN_FACTOR", format!("{factor_bits}'d{}", sums.factor)),
            ("MEAN_SHIFT", sums.shift.to_string()),
        ];
        list.extend(means.map(named));
    }
    list.extend(class_parameters(&design));
    list
}

fn flow_parameters(search: &FlowSearch) -> [(&'static str, String); 5] {
    let bits = search.factor_bits;
    // The first factor is in the lowest bits.
    let factors = search.factors.iter().rev().map(|factor| format!("{bits}'d{factor}"));
    [
        ("FLOW_RADIUS", search.radius.to_string()),
        ("FLOW_FACTOR_BITS", bits.to_string()),
        ("FLOW_FACTORS", format!("{{{}}}", factors.collect::<Vec<_>>().join(", "))),
        ("LEAST_BITS", search.product_bits.to_string()),
        ("COORDINATE_BITS", search.coordinate_bits().to_string()),
    ]
}

/// Returns the parameter with the number of a feature's score, which is 0 for a feature that the
/// design does not have.
fn score_index(design: SerialDesign<'_>, kind: FeatureKind) -> (String, String) {
    let place = design.features().iter().position(|feature| feature.kind() == kind);
    let index = place.map_or(0, |place| place + 1);
    (format!("{}_INDEX", parameter_prefix(kind)), index.to_string())
}

/// Returns the inputs of the array for the level of a feature, that of keen regions last, and the
/// signals connected to them. The array has these inputs even if the design lacks the feature. The
/// list is empty for a feature that has no level.
fn level_inputs(design: SerialDesign<'_>, kind: FeatureKind) -> Vec<(&'static str, String)> {
    let classes: [(RegionClass, ThresholdSignal); 2] =
        [(RegionClass::Normal, threshold_signal), (RegionClass::Keen, keen_signal)];
    let whole = || classes.map(|(_, signal)| pixel_level(design, kind, signal));
    let (names, levels) = match kind {
        FeatureKind::Edge => (
            ["edge_half_i", "keen_edge_half_i"],
            classes.map(|(class, signal)| half_level(design, kind, class, signal)),
        ),
        FeatureKind::Corner => (["corner_level_i", "keen_corner_level_i"], whole()),
        FeatureKind::Segment => (["segment_level_i", "keen_segment_level_i"], whole()),
        FeatureKind::Mad
        | FeatureKind::Variance
        | FeatureKind::Range
        | FeatureKind::Surface
        | FeatureKind::Flow => return Vec::new(),
    };
    names.into_iter().zip(levels).collect()
}

/// Returns the signal of a level that has the bits of a pixel, or zero without the feature.
fn pixel_level(design: SerialDesign<'_>, kind: FeatureKind, signal: ThresholdSignal) -> String {
    let given = design.feature(kind).map(|_| signal(&design, PortRole::Level(kind)));
    given.unwrap_or_else(|| format!("{}'d0", design.pixel_bits()))
}

/// Returns floor(level / 2) of a feature in regions of a class, two bits wider than a pixel.
fn half_level(
    design: SerialDesign<'_>,
    kind: FeatureKind,
    class: RegionClass,
    signal: ThresholdSignal,
) -> String {
    let width = design.pixel_bits() + 2;
    let thresholds = design.class_thresholds(class);
    let found = thresholds.features.iter().find(|feature| feature.kind() == kind);
    let Some(feature) = found else { return format!("{width}'d0") };
    match design.threshold_source() {
        ThresholdSource::Constant => {
            format!("{width}'d{}", feature.level().expect("the feature has a level") / 2)
        }
        ThresholdSource::Runtime => {
            let level = signal(&design, PortRole::Level(kind));
            let half = format!("{level}[{}:1]", feature.level_bits() - 1);
            zero_extended(&half, feature.level_bits() - 1, width)
        }
    }
}

/// Returns the minima of all scores, that of the last feature first. `signal` returns the signal of
/// a threshold.
fn minima(design: SerialDesign<'_>, signal: ThresholdSignal) -> Vec<String> {
    let width = design.max_score_bits();
    let minimum = |feature: &SpatialFeature| {
        let name = signal(&design, PortRole::MinScore(feature.kind()));
        zero_extended(&name, feature.score_bits(), width)
    };
    let mut list: Vec<_> = design.features().iter().rev().map(minimum).collect();
    list.push(zero_extended(
        &signal(&design, PortRole::TemporalMinCount),
        design.count_bits(),
        width,
    ));
    list
}

fn zero_extended(value: &str, bits: u32, width: u32) -> String {
    match width - bits {
        0 => value.to_owned(),
        zeros => format!("{{{zeros}'d0, {value}}}"),
    }
}
