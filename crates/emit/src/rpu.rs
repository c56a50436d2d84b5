// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills `rpu.v`: every number and name of the template is computed here, from the design.

mod temporal_score;

use self::temporal_score::{
    ReferenceCandidate, compared_values, keeps_second_frame, reference_candidates, unused_flags,
};
use super::camera_flags::{ThresholdConstant, scores_text, threshold_constants, threshold_signal};
use crate::camera_flags::{blanks_flag, last_sent_flag};
use crate::leaf::filter_leaf;
use crate::verilog_text::{PortLine, rendered_text};
use crate::{banner, latency_text};
use askama::Template;
use foveate_camera::{
    DenoiseFilter, FeatureKind, MeanDivision, Neighborhood, Periphery, SpatialFeature,
    VoteCombination, bits_for, index_bits,
};
use foveate_design::{Design, PipelinedDesign, PipelinedTiming, Pipelining, PortRole, keen_role};

#[derive(Template)]
#[template(path = "rpu.v")]
struct RpuModule {
    banner: String,
    summary: String,
    latency: String,
    ports: Vec<PortLine>,
    constants: Vec<ThresholdConstant>,
    // Geometry.
    n: u32,
    p: u32,
    pixels: u32,
    address_bits: u32,
    count_bits: u32,
    stream_side: u32,
    stream_side_bits: u32,
    stream_pixels: u32,
    raw_address_bits: u32,
    window_side: u32,
    window_side_bits: u32,
    // Parts that the design has.
    shared: bool,
    border: bool,
    filter: Option<FilterInstance>,
    window: bool,
    keeps_raw: bool,
    keeps_second: bool,
    tail_delay: bool,
    deep: bool,
    zones: bool,
    filter_registers: u32,
    /// The prefix of the signals that are counted: `tail`, or `count` where they come a clock after
    /// the store.
    count: &'static str,
    second_pass: bool,
    last_sent: bool,
    blanks: u32,
    // Scores.
    windowed: Vec<WindowFeature>,
    sums: bool,
    sum_bits: u32,
    mean: Option<MeanParameters>,
    mad_bits: Option<u32>,
    segment: Option<SegmentParameters>,
    variance: Option<VarianceWidths>,
    range: bool,
    surface_bits: Option<u32>,
    compared: Vec<&'static str>,
    references: Vec<ReferenceCandidate>,
    temporal_level: String,
    scores: Vec<ScorePort>,
    votes: Vec<String>,
    all: u32,
    periphery: Option<SummaryParameters>,
    decided_pixel: &'static str,
    forward_pixel: &'static str,
    unused: Vec<&'static str>,
}

/// The module that denoises.
struct FilterInstance {
    module: &'static str,
    instance: &'static str,
    /// The port with the denoised pixel.
    output: &'static str,
    is_switching: bool,
}

/// The parts that the features of a design need.
#[derive(Default)]
struct SpatialParts {
    windowed: Vec<WindowFeature>,
    /// True if the pixels of a region are summed.
    sums: bool,
    /// Bits of the score of `mad`.
    mad_bits: Option<u32>,
    segment: Option<SegmentParameters>,
    variance: Option<VarianceWidths>,
    range: bool,
    /// Bits of the score of `surface`.
    surface_bits: Option<u32>,
}

/// A feature whose score is the number of hits of a window.
struct WindowFeature {
    name: &'static str,
    level: String,
    /// The parameters of the detector in addition to the width of a pixel.
    parameters: String,
}

struct MeanParameters {
    fraction: u32,
    bits: u32,
    dividend_bits: u32,
    factor: u64,
    factor_bits: u32,
    shift: u32,
}

struct SegmentParameters {
    level: String,
    score_bits: u32,
}

struct VarianceWidths {
    square_bits: u32,
    square_sum_bits: u32,
    product_bits: u32,
    score_bits: u32,
}

/// The computation of the means of blocks, and the level above which they are sent.
struct SummaryParameters {
    blocks: u32,
    sum_bits: u32,
    factor: u64,
    factor_bits: u32,
    shift: u32,
    level: String,
    /// The signal with the pixels that are averaged.
    pixel: &'static str,
}

/// A score between its computation and its port and vote.
struct ScorePort {
    name: String,
    width: u32,
    minimum: String,
    /// True if the score waits for a feature with a second pass.
    is_held: bool,
}

pub(crate) fn render(design: PipelinedDesign<'_>) -> String {
    rendered_text(&view(design))
}

fn view(design: PipelinedDesign<'_>) -> RpuModule {
    let second_pass = design.has_second_pass();
    let reference = design.temporal().reference;
    let keeps_raw = design.has_separate_raw_pixels();
    let shared = design.neighborhood() == Neighborhood::Shared;
    let features = design.features();
    let window_side = design.denoised_side();
    let timing = PipelinedTiming::from_design(design);
    let deep = design.pipelining() == Pipelining::Deep;
    let SpatialParts { windowed, sums, mad_bits, segment, variance, range, surface_bits } =
        SpatialParts::of(design);
    RpuModule {
        banner: banner(&design),
        summary: scores_text(&design),
        latency: latency_text(design),
        ports: PortLine::aligned(&design.rpu_ports(), |_| None),
        constants: threshold_constants(&design),
        n: design.region_size(),
        p: design.pixel_bits(),
        pixels: design.region_pixels(),
        address_bits: design.position_bits(),
        count_bits: design.count_bits(),
        stream_side: design.stream_side(),
        stream_side_bits: index_bits(design.stream_side().into()),
        stream_pixels: design.stream_pixels(),
        raw_address_bits: index_bits(u64::from(window_side).pow(2)),
        window_side,
        window_side_bits: index_bits(window_side.into()),
        shared,
        border: design.needs_border(),
        filter: filter_instance(design.filter(), deep),
        window: design.has_feature_window(),
        keeps_raw,
        keeps_second: keeps_second_frame(design),
        tail_delay: has_tail_registers(&timing, deep),
        deep,
        zones: design.zones().is_some(),
        filter_registers: timing.filter_registers,
        count: if deep { "count" } else { "tail" },
        second_pass,
        last_sent: last_sent_flag(&design),
        blanks: u32::from(blanks_flag(&design)),
        windowed,
        sums,
        sum_bits: design.pixel_sum_bits(),
        mean: design.second_pass_mean().map(mean_parameters),
        mad_bits,
        segment,
        variance,
        range,
        surface_bits,
        compared: compared_values(reference, second_pass, deep),
        references: reference_candidates(reference, second_pass, deep),
        temporal_level: class_threshold(
            &design,
            PortRole::TemporalLevel,
            if deep { "count_keen" } else { "tail_keen" },
        ),
        scores: score_ports(design),
        votes: features.iter().map(|f| format!("{}_score", f.kind())).collect(),
        all: u32::from(design.combine() == VoteCombination::All),
        periphery: design.periphery().map(|periphery| summary_parameters(design, periphery)),
        decided_pixel: if second_pass { "second_pixel" } else { "previous_pixel" },
        forward_pixel: match (second_pass, keeps_raw) {
            (false, false) => "previous_pixel",
            (false, true) => "previous_raw",
            (true, false) => "second_pixel",
            (true, true) => "second_raw",
        },
        unused: unused_flags(reference, second_pass),
    }
}

/// Returns whether the tail begins with registers: one in front of the store, and in a deep design
/// one behind it.
fn has_tail_registers(timing: &PipelinedTiming, deep: bool) -> bool {
    match (timing.tail_delay, deep) {
        (0, false) => false,
        (1, false) | (2, true) => true,
        (clocks, _) => unreachable!("the template has no tail of {clocks} clocks"),
    }
}

impl SpatialParts {
    fn of(design: PipelinedDesign<'_>) -> Self {
        let mut own = Self::default();
        for feature in design.features() {
            match feature.kind() {
                FeatureKind::Edge | FeatureKind::Corner => {
                    own.windowed.push(window_feature(design, feature));
                }
                FeatureKind::Mad => {
                    own.sums = true;
                    own.mad_bits = Some(feature.score_bits());
                }
                FeatureKind::Segment => {
                    own.sums = true;
                    own.segment = Some(segment_parameters(design, feature));
                }
                FeatureKind::Variance => {
                    own.sums = true;
                    let widths = feature.variance().expect("variance has accumulators");
                    own.variance = Some(variance_widths(feature, widths));
                }
                FeatureKind::Range => own.range = true,
                FeatureKind::Surface => own.surface_bits = Some(feature.score_bits()),
                FeatureKind::Flow => unreachable!("pipelined refuses flow"),
            }
        }
        own
    }
}

fn filter_instance(filter: DenoiseFilter, deep: bool) -> Option<FilterInstance> {
    let (instance, output, is_switching) = match filter {
        DenoiseFilter::None => return None,
        DenoiseFilter::Median3x3 => ("u_median", "median_o", false),
        DenoiseFilter::Switching3x3 => ("u_median", "median_o", true),
        DenoiseFilter::Binomial3x3 => ("u_binomial", "mean_o", false),
    };
    Some(FilterInstance { module: filter_leaf(filter, deep)?, instance, output, is_switching })
}

fn window_feature(design: PipelinedDesign<'_>, feature: &SpatialFeature) -> WindowFeature {
    let kind = feature.kind();
    // A level that is not compared with a pixel has a width of its own.
    let parameters = match feature.level_bits() {
        bits if bits == design.pixel_bits() => String::new(),
        bits => format!(", .LEVEL_BITS({bits})"),
    };
    let level = class_threshold(&design, PortRole::Level(kind), "front_keen");
    WindowFeature { name: kind.name(), level, parameters }
}

/// Returns the threshold of the class of a region. `keen` is the signal that says that the region
/// is keen; a design without zones has no such signal.
fn class_threshold(design: &Design, role: PortRole, keen: &str) -> String {
    let own = threshold_signal(design, role);
    match design.zones() {
        None => own,
        Some(_) => format!("{keen} ? {} : {own}", threshold_signal(design, keen_role(role))),
    }
}

/// Returns a threshold in the clock of the decision.
fn decided_threshold(design: &Design, role: PortRole) -> String {
    class_threshold(design, role, "decided_keen")
}

/// Returns the level of summaries in the clock of the decision.
fn summary_level(design: &Design) -> String {
    let level = decided_threshold(design, PortRole::SummaryLevel);
    match design.zones() {
        None => level,
        Some(_) => {
            let off = threshold_signal(design, PortRole::OffSummaryLevel);
            format!("decided_class == 2'd1 ? {off} : {level}")
        }
    }
}

fn mean_parameters(mean: &MeanDivision) -> MeanParameters {
    MeanParameters {
        fraction: mean.fraction_bits,
        bits: mean.mean_bits,
        dividend_bits: mean.dividend_bits,
        factor: mean.reciprocal.multiplier(),
        factor_bits: bits_for(mean.reciprocal.multiplier()),
        shift: mean.reciprocal.shift(),
    }
}

fn segment_parameters(design: PipelinedDesign<'_>, feature: &SpatialFeature) -> SegmentParameters {
    SegmentParameters {
        level: class_threshold(&design, PortRole::Level(feature.kind()), "done_keen"),
        score_bits: feature.score_bits(),
    }
}

fn variance_widths(
    feature: &SpatialFeature,
    widths: &foveate_camera::VarianceWidths,
) -> VarianceWidths {
    VarianceWidths {
        square_bits: widths.square_bits,
        square_sum_bits: widths.square_sum_bits,
        product_bits: widths.product_bits,
        score_bits: feature.score_bits(),
    }
}

fn summary_parameters(design: PipelinedDesign<'_>, periphery: &Periphery) -> SummaryParameters {
    SummaryParameters {
        blocks: periphery.blocks,
        sum_bits: periphery.sum_bits,
        factor: periphery.reciprocal.multiplier(),
        factor_bits: bits_for(periphery.reciprocal.multiplier()),
        shift: periphery.reciprocal.shift(),
        level: summary_level(&design),
        pixel: if design.has_separate_raw_pixels() { "tail_raw" } else { "tail_pixel" },
    }
}

fn score_ports(design: PipelinedDesign<'_>) -> Vec<ScorePort> {
    let second_pass = design.has_second_pass();
    let mut list: Vec<_> = design
        .features()
        .iter()
        .map(|feature| ScorePort {
            name: format!("{}_score", feature.kind()),
            width: feature.score_bits(),
            minimum: decided_threshold(&design, PortRole::MinScore(feature.kind())),
            is_held: second_pass && !feature.kind().has_second_pass(),
        })
        .collect();
    list.push(ScorePort {
        name: "temporal_count".to_owned(),
        width: design.count_bits(),
        minimum: decided_threshold(&design, PortRole::TemporalMinCount),
        is_held: second_pass,
    });
    list
}
