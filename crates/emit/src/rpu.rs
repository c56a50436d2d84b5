// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills `rpu.v`: every number and name of the template is computed here, from the design.

mod temporal;

use self::temporal::{Candidate, candidates, compared, keeps_second, unused};
use crate::camera::{blanks, last_sent};
use crate::text::{PortLine, text_of};
use crate::thresholds::{Constant, constants, signal, summary};
use crate::{banner, latency};
use askama::Template;
use foveate_design::{
    Combine, FeatureKind, Filter, Mean, Neighborhood, Periphery, PipelinedDesign, PipelinedTiming,
    Pipelining, PortRole, SpatialFeature, Variance, bits_for, index_bits,
};

#[derive(Template)]
#[template(path = "rpu.v")]
struct Rpu {
    banner: String,
    summary: String,
    latency: String,
    ports: Vec<PortLine>,
    constants: Vec<Constant>,
    // Geometry.
    n: u32,
    p: u32,
    pixels: u32,
    address_bits: u32,
    count_bits: u32,
    stream_side: u32,
    stream_side_bits: u32,
    stream_pixels: u32,
    median_address_bits: u32,
    window_side: u32,
    window_side_bits: u32,
    // Parts that the design has.
    shared: bool,
    border: bool,
    median: bool,
    window: bool,
    keeps_raw: bool,
    keeps_second: bool,
    tail_delay: bool,
    deep: bool,
    median_registers: u32,
    /// The prefix of the signals that are counted: `tail`, or `count` where they come a clock after
    /// the store.
    count: &'static str,
    second_pass: bool,
    last_sent: bool,
    blanks: u32,
    // Scores.
    windowed: Vec<Windowed>,
    sums: bool,
    sum_bits: u32,
    mad: Option<Mad>,
    variance: Option<VarianceWidths>,
    compared: Vec<&'static str>,
    references: Vec<Candidate>,
    temporal_level: String,
    scores: Vec<Score>,
    votes: Vec<String>,
    all: u32,
    periphery: Option<Summaries>,
    decided_pixel: &'static str,
    forward_pixel: &'static str,
    unused: Vec<&'static str>,
}

/// The parts that the features of a design need.
#[derive(Default)]
struct Spatial {
    windowed: Vec<Windowed>,
    /// Whether the pixels of a region are summed.
    sums: bool,
    mad: Option<Mad>,
    variance: Option<VarianceWidths>,
}

/// A feature whose score is the number of hits of a window.
struct Windowed {
    name: &'static str,
    level: String,
    /// The parameters of the detector in addition to the width of a pixel.
    parameters: String,
}

struct Mad {
    fraction: u32,
    mean_bits: u32,
    dividend_bits: u32,
    factor: u64,
    factor_bits: u32,
    shift: u32,
    score_bits: u32,
}

struct VarianceWidths {
    square_bits: u32,
    square_sum_bits: u32,
    product_bits: u32,
    score_bits: u32,
}

/// The computation of the means of blocks, and the level above which they are sent.
struct Summaries {
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
struct Score {
    name: String,
    width: u32,
    minimum: String,
    /// Whether the score waits for a feature with a second pass.
    held: bool,
}

pub(crate) fn render(design: PipelinedDesign<'_>) -> String {
    text_of(&view(design))
}

fn view(design: PipelinedDesign<'_>) -> Rpu {
    let second_pass = design.has_second_pass();
    let reference = design.temporal().reference;
    let keeps_raw = design.keeps_raw();
    let shared = design.neighborhood() == Neighborhood::Shared;
    let features = design.features();
    let window_side = design.denoised_side();
    let timing = PipelinedTiming::of(design);
    let deep = design.pipelining() == Pipelining::Deep;
    let Spatial { windowed, sums, mad, variance } = Spatial::of(design);
    Rpu {
        banner: banner(&design),
        summary: summary(&design),
        latency: latency(design),
        ports: PortLine::all(&design.rpu_ports(), |_| None),
        constants: constants(&design),
        n: design.region_size(),
        p: design.pixel_bits(),
        pixels: design.region_pixels(),
        address_bits: design.position_bits(),
        count_bits: design.count_bits(),
        stream_side: design.stream_side(),
        stream_side_bits: index_bits(design.stream_side().into()),
        stream_pixels: design.stream_pixels(),
        median_address_bits: index_bits(u64::from(window_side).pow(2)),
        window_side,
        window_side_bits: index_bits(window_side.into()),
        shared,
        border: design.needs_border(),
        median: design.filter() != Filter::None,
        window: design.has_feature_window(),
        keeps_raw,
        keeps_second: keeps_second(design),
        tail_delay: has_tail_registers(&timing, deep),
        deep,
        median_registers: timing.median_registers,
        count: if deep { "count" } else { "tail" },
        second_pass,
        last_sent: last_sent(&design),
        blanks: u32::from(blanks(&design)),
        windowed,
        sums,
        sum_bits: design.pixel_sum_bits(),
        mad,
        variance,
        compared: compared(reference, second_pass, deep),
        references: candidates(reference, second_pass, deep),
        temporal_level: signal(&design, PortRole::TemporalLevel),
        scores: scores(design),
        votes: features.iter().map(|f| format!("{}_score", f.kind())).collect(),
        all: u32::from(design.combine() == Combine::All),
        periphery: design.periphery().map(|periphery| summaries(design, periphery)),
        decided_pixel: if second_pass { "second_pixel" } else { "previous_pixel" },
        forward_pixel: match (second_pass, keeps_raw) {
            (false, false) => "previous_pixel",
            (false, true) => "previous_raw",
            (true, false) => "second_pixel",
            (true, true) => "second_raw",
        },
        unused: unused(reference, second_pass),
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

impl Spatial {
    fn of(design: PipelinedDesign<'_>) -> Self {
        let mut own = Self::default();
        for feature in design.features() {
            match feature.kind() {
                FeatureKind::Edge | FeatureKind::Corner => {
                    own.windowed.push(windowed(design, feature));
                }
                FeatureKind::Mad => {
                    own.sums = true;
                    own.mad = Some(mad(feature, feature.mean().expect("mad has a mean")));
                }
                FeatureKind::Variance => {
                    own.sums = true;
                    let widths = feature.variance().expect("variance has accumulators");
                    own.variance = Some(variance(feature, widths));
                }
            }
        }
        own
    }
}

fn windowed(design: PipelinedDesign<'_>, feature: &SpatialFeature) -> Windowed {
    let kind = feature.kind();
    // A level that is not compared with a pixel has a width of its own.
    let parameters = match feature.level_bits() {
        bits if bits == design.pixel_bits() => String::new(),
        bits => format!(", .LEVEL_BITS({bits})"),
    };
    let level = signal(&design, PortRole::Level(kind));
    Windowed { name: kind.name(), level, parameters }
}

fn mad(feature: &SpatialFeature, mean: &Mean) -> Mad {
    Mad {
        fraction: mean.fraction_bits,
        mean_bits: mean.mean_bits,
        dividend_bits: mean.dividend_bits,
        factor: mean.reciprocal.multiplier(),
        factor_bits: bits_for(mean.reciprocal.multiplier()),
        shift: mean.reciprocal.shift(),
        score_bits: feature.score_bits(),
    }
}

fn variance(feature: &SpatialFeature, widths: &Variance) -> VarianceWidths {
    VarianceWidths {
        square_bits: widths.square_bits,
        square_sum_bits: widths.square_sum_bits,
        product_bits: widths.product_bits,
        score_bits: feature.score_bits(),
    }
}

fn summaries(design: PipelinedDesign<'_>, periphery: &Periphery) -> Summaries {
    Summaries {
        blocks: periphery.blocks,
        sum_bits: periphery.sum_bits,
        factor: periphery.reciprocal.multiplier(),
        factor_bits: bits_for(periphery.reciprocal.multiplier()),
        shift: periphery.reciprocal.shift(),
        level: signal(&design, PortRole::SummaryLevel),
        pixel: if design.keeps_raw() { "tail_raw" } else { "tail_pixel" },
    }
}

fn scores(design: PipelinedDesign<'_>) -> Vec<Score> {
    let second_pass = design.has_second_pass();
    let mut list: Vec<_> = design
        .features()
        .iter()
        .map(|feature| Score {
            name: format!("{}_score", feature.kind()),
            width: feature.score_bits(),
            minimum: signal(&design, PortRole::MinScore(feature.kind())),
            held: second_pass && !feature.kind().has_second_pass(),
        })
        .collect();
    list.push(Score {
        name: "temporal_count".to_owned(),
        width: design.count_bits(),
        minimum: signal(&design, PortRole::TemporalMinCount),
        held: second_pass,
    });
    list
}
