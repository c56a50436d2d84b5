// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills `raster.v`, the top of a raster design: the core, or the core for the smallest frame.

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
use foveate_camera::{FeatureKind, Neighborhood, SpatialFeature, VoteCombination, bits_for};
use foveate_design::{
    Design, FRAME_NUMBERS, FrameStoreKind, Organization, Pipelining, Port, PortRole, RasterDesign,
    RasterTiming,
};

#[derive(Template)]
#[template(path = "raster.v")]
struct RasterTop {
    banner: String,
    title: String,
    summary: String,
    lanes: u32,
    pipelining: &'static str,
    clocks: String,
    module: &'static str,
    columns: u32,
    rows: u32,
    n: u32,
    pad_columns: u32,
    pad_rows: u32,
    ports: Vec<PortLine>,
    constants: Vec<ThresholdConstant>,
    /// The outputs of the core that are no ports of the design.
    unused: Vec<UnusedOutput>,
    /// The first map of classes, in a design with zones.
    first_map: Option<String>,
    parameters: Vec<(String, String)>,
    /// The inputs of the core for the levels of pixels, and the signals connected to them.
    levels: Vec<(String, String)>,
    /// The minima and the scores, those of the last feature first.
    minima: Vec<String>,
    keen_minima: Vec<String>,
    /// The ports of the memory of classes, and the signals connected to them.
    classes: [(&'static str, &'static str); 5],
    scores: Vec<String>,
    /// The ports of the core to an external frame store and for the pixels that leave, and the
    /// signals connected to them.
    streams: Vec<(&'static str, String)>,
    sync: Option<FrameSync>,
    valid: &'static str,
    ready: &'static str,
}

struct UnusedOutput {
    name: String,
    /// The range of the signal; empty for one bit.
    range: String,
}

/// Returns the top: the core, or the core for the smallest frame.
pub(crate) fn modules(design: RasterDesign<'_>, top: Top) -> Vec<SourceFile> {
    let lone = design.lone_unit();
    let view = match top {
        Top::Rpu => view(lone.with_hardware(design.own_hardware()), &design, top),
        Top::Rcm => view(design, &design, top),
    };
    vec![module_file(top.module(), rendered_text(&view))]
}

/// Returns the range of a port whose width depends on the grid; `None` for other ports.
fn port_range(port: &Port) -> Option<String> {
    use PortRole::{ClassAddress, ForwardRegion, LostRegion, Region};
    match port.role {
        Region | ForwardRegion | LostRegion => Some("[$clog2(COLUMNS*ROWS)-1:0]".to_owned()),
        ClassAddress => Some(class_address_range()),
        _ => None,
    }
}

fn view(design: RasterDesign<'_>, named: &Design, top: Top) -> RasterTop {
    let timing = RasterTiming::from_design(design);
    let n = design.region_size();
    let mut unused = Vec::new();
    let streams = stream_connections(design, &mut unused);
    RasterTop {
        banner: banner(named),
        title: format!(
            "The camera for frames that come row by row: COLUMNS x ROWS regions of {n}x{n} {}-bit pixels.",
            design.pixel_bits()
        ),
        summary: scores_text(&design),
        lanes: design.pixels_per_clock(),
        pipelining: design.pipelining().name(),
        clocks: format!("{} clocks, with the grid above", timing.clocks_per_frame()),
        module: top.module(),
        columns: design.columns(),
        rows: design.rows(),
        n,
        pad_columns: design.columns() * n - design.width(),
        pad_rows: design.rows() * n - design.height(),
        ports: PortLine::aligned(&top.ports(named), port_range),
        constants: threshold_constants(&design),
        unused,
        first_map: first_map(&design),
        parameters: core_parameters(design, &timing),
        levels: level_inputs(design),
        minima: minima(design, threshold_signal),
        keen_minima: minima(design, keen_signal),
        classes: class_connections(&design),
        scores: score_signals(design),
        streams,
        sync: FrameSync::with_ready(&design, frame_beats(design)),
        valid: top::valid_signal(&design),
        ready: top::ready_signal(&design),
    }
}

/// Returns the number of beats of a frame in terms of the grid: the taken words of a row times the
/// rows.
fn frame_beats(design: RasterDesign<'_>) -> String {
    let (n, pixels) = (design.region_size(), design.pixels_per_clock());
    let length = |regions: &str, beyond: u32| match beyond {
        0 => format!("{regions} * {n}"),
        _ => format!("({regions} * {n} - {beyond})"),
    };
    let width = length("COLUMNS", design.columns() * n - design.width());
    let height = length("ROWS", design.rows() * n - design.height());
    match pixels {
        1 => format!("{width} * {height}"),
        _ => format!("(({width} + {}) / {pixels}) * {height}", pixels - 1),
    }
}

/// Returns the range of a signal of this width; empty for one bit.
fn bit_range(width: u32) -> String {
    if width == 1 { String::new() } else { format!("[{}:0]", width - 1) }
}

/// Connects the streams of the core to the ports that the design has.
fn stream_connections(
    design: RasterDesign<'_>,
    unused: &mut Vec<UnusedOutput>,
) -> Vec<(&'static str, String)> {
    let word = design.pixels_per_clock() * design.pixel_bits();
    let has: Vec<String> = design.rcm_ports().into_iter().map(|port| port.name).collect();
    let mut list = Vec::new();
    for (port, width) in
        [("reference_valid_i", 1), ("reference_pixel_i", word), ("forward_ready_i", 1)]
    {
        let given = has.iter().any(|name| name == port);
        list.push((port, if given { port.to_owned() } else { format!("{width}'d0") }));
    }
    let (region, frame) = ("[$clog2(COLUMNS*ROWS)-1:0]".to_owned(), FRAME_NUMBERS.ilog2());
    for (name, range) in [
        ("summary_o", String::new()),
        ("reference_ready_o", String::new()),
        ("store_valid_o", String::new()),
        ("store_pixel_o", bit_range(word)),
        ("store_last_o", String::new()),
        ("underrun_o", String::new()),
        ("forward_valid_o", String::new()),
        ("forward_region_o", region.clone()),
        ("forward_position_o", bit_range(design.position_bits())),
        ("forward_pixel_o", bit_range(word)),
        ("forward_first_o", String::new()),
        ("forward_last_o", String::new()),
        ("forward_abort_o", String::new()),
        ("forward_frame_o", bit_range(frame)),
        ("forward_summary_o", String::new()),
        ("lost_o", String::new()),
        ("lost_count_o", bit_range(16)),
        ("lost_valid_o", String::new()),
        ("lost_region_o", region),
        ("lost_frame_o", bit_range(frame)),
    ] {
        let given = has.iter().any(|port| port == name);
        let signal = if given {
            name.to_owned()
        } else {
            let name = name.trim_end_matches("_o").to_owned();
            let signal = format!("unused_{name}");
            unused.push(UnusedOutput { name, range });
            signal
        };
        list.push((name, signal));
    }
    list
}

/// Returns the features in the order in which the core has their scores.
fn features_in_core_order(design: RasterDesign<'_>) -> Vec<&SpatialFeature> {
    let mut list: Vec<_> = design.design().features().iter().collect();
    list.sort_by_key(|feature| score_rank(feature.kind()));
    list
}

/// Returns the rank of a feature's score in the core: counts come first, then the scores of sums
/// and extremes, then those of the second pass.
fn score_rank(kind: FeatureKind) -> u32 {
    match kind {
        FeatureKind::Edge => 0,
        FeatureKind::Corner => 1,
        FeatureKind::Variance => 2,
        FeatureKind::Range => 3,
        FeatureKind::Surface => 4,
        FeatureKind::Mad => 5,
        FeatureKind::Segment => 6,
        FeatureKind::Flow => unreachable!("raster refuses flow"),
    }
}

fn core_parameters(design: RasterDesign<'_>, timing: &RasterTiming) -> Vec<(String, String)> {
    let flag = |condition: bool| u32::from(condition);
    let scores = design.features().iter().map(SpatialFeature::score_bits).sum::<u32>();
    let edge_level_bits = level_bits(design, FeatureKind::Edge).expect("edge has a level");
    let mut list = vec![
        ("WIDTH", design.pixel_bits()),
        ("LANES", design.pixels_per_clock()),
        ("SIDE", design.region_size()),
        ("ISOLATED", flag(design.neighborhood() == Neighborhood::Isolated)),
        ("FILTER", filter_number(design.filter())),
        ("ALL", flag(design.combine() == VoteCombination::All)),
        ("LAST_SENT", flag(last_sent_flag(&design))),
        ("BLANKS", flag(blanks_flag(&design))),
        ("RAW", flag(design.has_separate_raw_pixels())),
        ("FORWARD", flag(design.has_forwarding())),
        ("STORE", store_number(design)),
        ("DEEP", flag(design.pipelining() == Pipelining::Deep)),
        ("SETTLE", timing.decision_latency),
        ("COUNT_BITS", design.count_bits()),
        ("SCORE_BITS", design.count_bits() + scores),
        ("EDGE_LEVEL_BITS", edge_level_bits),
        ("POSITION_BITS", design.position_bits()),
        ("FRAME_BITS", FRAME_NUMBERS.ilog2()),
    ];
    let mut wide = Vec::new();
    for feature in features_in_core_order(design) {
        let new = sum_widths(design, feature).into_iter().filter(|new| !list.contains(new));
        list.extend(new.collect::<Vec<_>>());
    }
    if let Some(mean) = design.second_pass_mean() {
        let factor = mean.reciprocal.multiplier();
        wide.push(("FACTOR", format!("{}'d{factor}", bits_for(factor))));
    }
    if let Some(periphery) = design.periphery() {
        let factor = periphery.reciprocal.multiplier();
        list.extend([
            ("BLOCKS", periphery.blocks),
            ("BLOCK_SUM_BITS", periphery.sum_bits),
            ("BLOCK_FACTOR_BITS", bits_for(factor)),
            ("BLOCK_SHIFT", periphery.reciprocal.shift()),
        ]);
        wide.push(("BLOCK_FACTOR", format!("{}'d{factor}", bits_for(factor))));
    }
    let list = list.into_iter().map(|(name, value)| (name, value.to_string())).chain(wide);
    let list = list.map(|(name, value)| (name.to_owned(), value));
    let kinds = Organization::Raster.feature_kinds().into_iter();
    let flags = kinds.map(|kind| feature_flag(design, kind));
    list.chain(flags).chain(class_parameters(&design)).collect()
}

/// Returns the parameter that says whether the design has a feature.
fn feature_flag(design: RasterDesign<'_>, kind: FeatureKind) -> (String, String) {
    (parameter_prefix(kind), u32::from(design.feature(kind).is_some()).to_string())
}

/// Returns the widths of a score and of the sums that it is computed from; none if the score is a
/// count.
fn sum_widths(design: RasterDesign<'_>, feature: &SpatialFeature) -> Vec<(&'static str, u32)> {
    let sum = ("SUM_BITS", design.pixel_sum_bits());
    match feature.kind() {
        FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Range => vec![],
        // The score is a sum of differences of pixels, which has as many bits as a sum of pixels.
        FeatureKind::Surface => vec![sum],
        FeatureKind::Flow => unreachable!("raster refuses flow"),
        FeatureKind::Mad => {
            [vec![sum, ("MAD_BITS", feature.score_bits())], mean_widths(feature)].concat()
        }
        FeatureKind::Segment => {
            [vec![sum, ("SEGMENT_BITS", feature.score_bits())], mean_widths(feature)].concat()
        }
        FeatureKind::Variance => {
            let variance = feature.variance().expect("variance has accumulators");
            vec![
                sum,
                ("VARIANCE_BITS", feature.score_bits()),
                ("SQUARE_SUM_BITS", variance.square_sum_bits),
                ("PRODUCT_BITS", variance.product_bits),
            ]
        }
    }
}

fn mean_widths(feature: &SpatialFeature) -> Vec<(&'static str, u32)> {
    let mean = feature.mean().expect("the features of the second pass have a mean");
    vec![
        ("FRACTION", mean.fraction_bits),
        ("DIVIDEND_BITS", mean.dividend_bits),
        ("MEAN_BITS", mean.mean_bits),
        ("FACTOR_BITS", bits_for(mean.reciprocal.multiplier())),
        ("SHIFT", mean.reciprocal.shift()),
    ]
}

/// Returns the number of bits of the core's level input of a feature, also of one that the design
/// does not have; `None` for a feature without a level.
fn level_bits(design: RasterDesign<'_>, kind: FeatureKind) -> Option<u32> {
    let most = match kind {
        FeatureKind::Edge => design.pixel_bits() + 3,
        FeatureKind::Corner | FeatureKind::Segment => design.pixel_bits(),
        FeatureKind::Mad
        | FeatureKind::Variance
        | FeatureKind::Range
        | FeatureKind::Surface
        | FeatureKind::Flow => return None,
    };
    Some(design.feature(kind).map_or(most, SpatialFeature::level_bits))
}

/// Returns the number of the design's frame store in the core.
fn store_number(design: RasterDesign<'_>) -> u32 {
    match design.store() {
        FrameStoreKind::Block => 0,
        FrameStoreKind::Ultra => 1,
        FrameStoreKind::SinglePort => 2,
        FrameStoreKind::External => 3,
    }
}

/// Returns the inputs of the core for the levels of pixels, and the signals connected to them.
fn level_inputs(design: RasterDesign<'_>) -> Vec<(String, String)> {
    let [keen_summary, off_summary] = class_summary_levels(&design);
    let mut list = vec![
        ("temporal_level_i".to_owned(), threshold_signal(&design, PortRole::TemporalLevel)),
        ("keen_temporal_level_i".to_owned(), keen_signal(&design, PortRole::TemporalLevel)),
        ("summary_level_i".to_owned(), summary_level_signal(&design)),
        ("keen_summary_level_i".to_owned(), keen_summary),
        ("off_summary_level_i".to_owned(), off_summary),
    ];
    for kind in Organization::Raster.feature_kinds() {
        if let Some(width) = level_bits(design, kind) {
            let signal = |own: ThresholdSignal| {
                let given = design.feature(kind).map(|_| own(&design, PortRole::Level(kind)));
                given.unwrap_or_else(|| format!("{width}'d0"))
            };
            list.push((format!("{kind}_level_i"), signal(threshold_signal)));
            list.push((format!("keen_{kind}_level_i"), signal(keen_signal)));
        }
    }
    list
}

/// Returns the minima of all scores, that of the changed pixels last. `signal` returns the signal
/// of a threshold.
fn minima(design: RasterDesign<'_>, signal: ThresholdSignal) -> Vec<String> {
    let roles =
        features_in_core_order(design).into_iter().rev().map(|f| PortRole::MinScore(f.kind()));
    let roles = roles.chain([PortRole::TemporalMinCount]);
    roles.map(|role| signal(&design, role)).collect()
}

/// Returns the ports of all scores, that of the changed pixels last.
fn score_signals(design: RasterDesign<'_>) -> Vec<String> {
    let features = features_in_core_order(design).into_iter().rev();
    let ports = features.map(|feature| format!("{}_score_o", feature.kind()));
    ports.chain(["temporal_count_o".to_owned()]).collect()
}
