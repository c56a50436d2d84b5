// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills `serial.v`, the top of a serial design: the array, or an array that has one lane.

use crate::branch::Values;
use crate::camera::{blanks, last_sent};
use crate::kinds::{deviations, kinds};
use crate::sync::{self, Sync};
use crate::text::{PortLine, file, text_of};
use crate::thresholds::{Constant, constants, signal, summary, summary_level};
use crate::{SourceFile, Top, banner};
use askama::Template;
use foveate_design::{
    AreaKind, Combine, FeatureKind, Feed, Filter, MemoryKind, Neighborhood, Pipelining, Port,
    PortRole, SerialDesign, SerialTiming, SpatialFeature, Thresholds, bits_for, index_bits,
};

#[derive(Template)]
#[template(path = "serial.v")]
struct Serial {
    banner: String,
    what: String,
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
    constants: Vec<Constant>,
    parameters: Vec<(&'static str, String)>,
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
    /// The inputs of the array for the levels of features, and the signals connected to them.
    levels: Vec<(&'static str, String)>,
    /// The minima of the scores, that of the last feature first and that of the changed pixels
    /// last.
    minima: Vec<String>,
    summary_level: String,
    summarizes: bool,
    sync: Option<Sync>,
    valid: &'static str,
    ready: &'static str,
}

/// The highest bit of the number of a region, in terms of the grid.
const REGION_RANGE: &str = "(COLUMNS*ROWS > 1 ? $clog2(COLUMNS*ROWS) : 1)-1";

/// Returns the top: the array, or the array that has one lane.
pub(crate) fn modules(design: SerialDesign<'_>, top: Top) -> Vec<SourceFile> {
    let lane = design.one_lane();
    let view = match top {
        Top::Rpu => view(lane.on(design.own()), design, top),
        Top::Rcm => view(design, design, top),
    };
    vec![file(top.module(), text_of(&view))]
}

/// Returns the parameters of a leaf that decide which parts it has.
pub(crate) fn values(design: SerialDesign<'_>, leaf: &str) -> Values {
    match leaf {
        "serial_array" => {
            let slots = design.lanes() * design.fold();
            let grid = [
                ("COLUMNS", design.columns()),
                ("ROWS", design.rows()),
                ("FOLD", design.fold()),
                ("LANES", design.lanes()),
                ("LANE_BITS", index_bits(design.lanes().into()).max(1)),
                ("REGION_BITS", index_bits(slots.into()).max(1)),
            ];
            let grid = grid.into_iter().map(|(name, value)| (name, value.to_string()));
            grid.chain(parameters(design)).collect()
        }
        "serial_lane" | "serial_memory" => {
            let block = design.lane_memory().kind == MemoryKind::Block;
            vec![("BLOCK", u32::from(block).to_string())]
        }
        _ => Vec::new(),
    }
}

/// Returns the range of a port whose width depends on the grid; `None` for other ports.
fn range(port: &Port, design: SerialDesign<'_>) -> Option<String> {
    match (port.role, port.per_lane, port.width) {
        (PortRole::Region | PortRole::ForwardRegion, _, _) => Some(format!("[{REGION_RANGE}:0]")),
        (_, true, 1) => Some(format!("[{}-1:0]", lanes(design))),
        (_, true, width) => Some(format!("[{}*{width}-1:0]", lanes(design))),
        (_, false, _) => None,
    }
}

/// Returns the number of lanes in terms of the grid.
fn lanes(design: SerialDesign<'_>) -> String {
    match design.fold() {
        1 => "COLUMNS*ROWS".to_owned(),
        fold => format!("((COLUMNS*ROWS+{})/{fold})", fold - 1),
    }
}

/// Returns the number of beats of a frame in terms of the grid.
fn beats(design: SerialDesign<'_>) -> String {
    match design.feed() {
        Feed::Parallel => (design.fold() * design.stream_pixels()).to_string(),
        Feed::Raster => format!("COLUMNS * ROWS * {}", design.region_pixels()),
    }
}

fn view(design: SerialDesign<'_>, named: SerialDesign<'_>, top: Top) -> Serial {
    let memory = design.lane_memory();
    let edge = design.feature(FeatureKind::Edge);
    let runtime = design.thresholds() == Thresholds::Runtime;
    Serial {
        banner: banner(&named),
        what: what(design, top),
        summary: summary(&design),
        memory: match memory.kind {
            MemoryKind::Distributed => "distributed RAM",
            MemoryKind::Block => "block RAM",
        },
        clocks: clocks(design),
        module: top.module(),
        columns: design.columns(),
        rows: design.rows(),
        // An array that has one lane may have more columns.
        widest: design.most_in_line().max(design.columns()),
        highest: design.most_in_line(),
        ports: PortLine::all(&top.ports(&named), |port| range(port, named)),
        constants: constants(&design).into_iter().filter(|c| c.name != "EDGE_LEVEL").collect(),
        parameters: parameters(design),
        fold: design.fold(),
        slot_bits: design.slot_bits(),
        center_bits: design.lane_widths().center,
        position_bits: design.position_bits(),
        raster: design.feed() == Feed::Raster,
        lanes: lanes(design),
        slots: format!("LANES*{}", design.fold()),
        slot_range: "(SLOTS > 1 ? $clog2(SLOTS) : 1)-1",
        region_range: REGION_RANGE,
        half_level: edge.is_some() && runtime,
        temporal_level: signal(&design, PortRole::TemporalLevel),
        levels: FeatureKind::ALL.iter().filter_map(|&kind| level(design, kind)).collect(),
        minima: minima(design),
        summary_level: summary_level(&design),
        summarizes: design.periphery().is_some(),
        sync: Sync::with_ready(&design, beats(design)),
        valid: sync::valid(&design),
        ready: sync::ready(&design),
    }
}

fn what(design: SerialDesign<'_>, top: Top) -> String {
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

fn clocks(design: SerialDesign<'_>) -> String {
    let timing = SerialTiming::of(design);
    format!(
        "{} clocks to take it and {} steps, with the grid above",
        timing.load_clocks(),
        timing.steps()
    )
}

fn parameters(design: SerialDesign<'_>) -> Vec<(&'static str, String)> {
    let memory = design.lane_memory();
    let widths = design.lane_widths();
    let median = design.filter() == Filter::Median3x3;
    let region = design.region_size();
    let base = |kind| memory.area(kind).map_or(0, |area| area.base);
    let fraction = design.features().iter().find_map(deviations);
    let flag = |condition: bool| u32::from(condition);
    let numbers = [
        ("WIDTH", design.pixel_bits()),
        ("SIDE", region),
        ("RAW_SIDE", design.stream_side()),
        ("DENOISED_SIDE", if median { design.denoised_side() } else { region }),
        ("MEDIAN", flag(median)),
        ("SHARED", flag(design.neighborhood() == Neighborhood::Shared)),
        ("LAST_SENT", flag(last_sent(&design))),
        ("BLANKS", flag(blanks(&design))),
        ("RAW_PAYLOAD", flag(design.keeps_raw())),
        ("RASTER", flag(design.feed() == Feed::Raster)),
        ("BLOCK", flag(memory.kind == MemoryKind::Block)),
        ("DEEP", flag(design.pipelining() == Pipelining::Deep)),
        ("FEATURES", design.score_count() - 1),
        ("ALL", flag(design.combine() == Combine::All)),
        ("FRACTION", fraction.map_or(0, |mean| mean.fraction_bits)),
        ("DENOISED_BASE", base(AreaKind::Denoised)),
        ("REFERENCE_BASE", base(AreaKind::Reference)),
        ("WORD_BITS", memory.slot_words.trailing_zeros()),
        ("SLOT_BITS", design.slot_bits()),
        ("ADDRESS_BITS", memory.address_bits),
        ("POSITION_BITS", widths.center),
        ("INDEX_BITS", design.score_index_bits()),
        ("COUNT_BITS", design.count_bits()),
        ("SCORE_BITS", design.any_score_bits()),
        ("SUM_BITS", design.pixel_sum_bits()),
        ("SCALE_BITS", widths.scale),
        ("ACC_BITS", widths.accumulator),
        ("AUX_BITS", widths.second),
        ("CHAIN_BITS", widths.chain),
    ];
    let mut list: Vec<_> = numbers.iter().map(|(name, value)| (*name, value.to_string())).collect();
    list.push(("KINDS", kinds(design.features().iter())));
    if let (Some(periphery), Some(sums)) = (design.periphery(), design.block_sums()) {
        let factor_bits = bits_for(sums.factor);
        list.extend([
            ("BLOCKS", periphery.blocks.to_string()),
            ("MEAN_DROPPED", sums.dropped.to_string()),
            ("MEAN_SUM_BITS", sums.passing.to_string()),
            ("MEAN_FACTOR_BITS", factor_bits.to_string()),
            ("MEAN_FACTOR", format!("{factor_bits}'d{}", sums.factor)),
            ("MEAN_SHIFT", sums.shift.to_string()),
        ]);
    }
    list
}

/// Returns the input of the array for the level of a feature, and the signal connected to it. The
/// array has this input even if the design lacks the feature. Returns `None` for a feature that has
/// no level.
fn level(design: SerialDesign<'_>, kind: FeatureKind) -> Option<(&'static str, String)> {
    match kind {
        FeatureKind::Edge => Some(("edge_half_i", edge_half(design))),
        FeatureKind::Corner => {
            let given = design.feature(kind).map(|_| signal(&design, PortRole::Level(kind)));
            let level = given.unwrap_or_else(|| format!("{}'d0", design.pixel_bits()));
            Some(("corner_level_i", level))
        }
        FeatureKind::Mad | FeatureKind::Variance => None,
    }
}

/// Returns floor(level / 2) of `edge`, two bits wider than a pixel.
fn edge_half(design: SerialDesign<'_>) -> String {
    let width = design.pixel_bits() + 2;
    let Some(edge) = design.feature(FeatureKind::Edge) else { return format!("{width}'d0") };
    match design.thresholds() {
        Thresholds::Constant => format!("{width}'d{}", edge.level().expect("edge has a level") / 2),
        Thresholds::Runtime => {
            let half = format!("edge_level_i[{}:1]", edge.level_bits() - 1);
            padded(&half, edge.level_bits() - 1, width)
        }
    }
}

fn minima(design: SerialDesign<'_>) -> Vec<String> {
    let width = design.any_score_bits();
    let minimum = |feature: &SpatialFeature| {
        let name = signal(&design, PortRole::MinScore(feature.kind()));
        padded(&name, feature.score_bits(), width)
    };
    let mut list: Vec<_> = design.features().iter().rev().map(minimum).collect();
    list.push(padded(&signal(&design, PortRole::TemporalMinCount), design.count_bits(), width));
    list
}

/// Returns a value of `bits` bits, extended with zeros to `width` bits.
fn padded(value: &str, bits: u32, width: u32) -> String {
    match width - bits {
        0 => value.to_owned(),
        zeros => format!("{{{zeros}'d0, {value}}}"),
    }
}
