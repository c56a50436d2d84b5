// SPDX-License-Identifier: MIT OR Apache-2.0
//! An array of RPUs behind a pattern: the top around it, and the sums of its signature
//! (docs/boards.md).

use std::borrow::Cow;

use askama::Template;
use foveate_camera::{FeatureKind, Payload, RegionAction, bits_for, index_bits};
use foveate_design::{Design, PipelinedDesign, PipelinedTiming, PortRole};
use foveate_emit::array_scores;
use foveate_engine::Engine;
use foveate_tools::escaping::comment_text;

use super::text_forms::rendered;
use crate::pattern::pattern_frame;
use crate::project::BoardProject;
use crate::sensor::LogicLevel;

/// The number of bits of a byte.
const BYTE: u32 = 8;

#[derive(Template)]
#[template(path = "array_board.v")]
struct ArrayTopTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    pair: bool,
    mhz: u32,
    leds: usize,
    lit_low: bool,
    columns: u32,
    rows: u32,
    side: u32,
    side_bits: u32,
    pixels: u32,
    count_bits: u32,
    head_bytes: u32,
    level_at: u32,
    temporal_at: u32,
    minimum_at: u32,
    turn_bits: u32,
    thresholds: Vec<ThresholdPort>,
    scores: Vec<ScorePort>,
    has_summary: bool,
    head: Vec<String>,
    pins: Vec<(String, String)>,
    divisor: u32,
    blink: u32,
}

/// A threshold of the array: its name, its range, and the output of `array_turn` that loads a new
/// value into it.
struct ThresholdPort {
    name: String,
    range: String,
    turn_signal: &'static str,
}

/// A port with a score of each region, or with its count of changed pixels.
struct ScorePort {
    name: String,
    width: u32,
    kind: Option<FeatureKind>,
}

impl ScorePort {
    fn byte_count(&self) -> u32 {
        self.width.div_ceil(BYTE)
    }
}

/// Returns the values of each region besides its decision: the count of changed pixels, and then
/// the scores in the order of the design.
fn score_ports(design: &Design) -> Vec<ScorePort> {
    let score = |port: foveate_design::Port| ScorePort {
        name: port.name.trim_end_matches("_o").to_owned(),
        width: port.width,
        kind: match port.role {
            PortRole::Score(kind) => Some(kind),
            _ => None,
        },
    };
    array_scores(design).into_iter().map(score).collect()
}

/// Returns the output of `array_turn` that loads a new value into a threshold.
fn turn_output(role: PortRole) -> &'static str {
    match role {
        PortRole::Level(_) => "level",
        PortRole::TemporalLevel => "temporal",
        _ => "minimum",
    }
}

fn range_text(width: u32) -> String {
    if width == 1 { String::new() } else { format!("[{}:0] ", width - 1) }
}

/// Returns the Verilog of the top around an array.
pub(crate) fn array_top(project: &BoardProject, array: PipelinedDesign<'_>) -> String {
    let board = &project.board;
    let (scores, timing) = (score_ports(&array), PipelinedTiming::from_design(array));
    let mut thresholds = Vec::new();
    for port in array.rcm_interface().controls {
        let name = port.name.trim_end_matches("_i").to_owned();
        thresholds.push(ThresholdPort {
            name,
            range: range_text(port.width),
            turn_signal: turn_output(port.role),
        });
    }
    let minimum_at = timing.decision_latency + 1 + timing.decision_frames * timing.cycles_per_frame;
    let mut head: Vec<String> = Vec::new();
    let mut pins = Vec::new();
    let mut low_bit = BYTE;
    for score in &scores {
        let (name, width) = (&score.name, score.width);
        let padding = score.byte_count() * BYTE - width;
        let value = format!("{name}[region*{width}+:{width}]");
        head.push(if padding == 0 { value } else { format!("{padding}'d0, {value}") });
        let mut pin = |part: String, from: u32, width: u32| {
            pins.push((part, format!("captured_head[{}:{from}]", from + width - 1)));
        };
        if width > 32 {
            pin(format!("captured_{name}_low_i"), low_bit, 32);
            pin(format!("captured_{name}_high_i"), low_bit + 32, width - 32);
        } else {
            pin(format!("captured_{name}_i"), low_bit, width);
        }
        low_bit += score.byte_count() * BYTE;
    }
    head.reverse();
    head.push("4'd0, active[region], summary[region], trs[region], srs[region]".to_owned());
    rendered(&ArrayTopTemplate {
        banner: project.banner(),
        title: comment_text(&board.title),
        pair: project.has_pair(),
        mhz: board.clock.mhz,
        leds: board.leds.pins.len(),
        lit_low: board.leds.lit_level == LogicLevel::Low,
        columns: array.columns(),
        rows: array.rows(),
        side: array.region_size(),
        side_bits: index_bits(array.region_size().into()),
        pixels: array.region_pixels(),
        count_bits: bits_for(array.region_pixels().into()),
        head_bytes: low_bit / BYTE,
        level_at: timing.decision_latency - timing.tail_delay,
        temporal_at: timing.decision_latency,
        minimum_at,
        turn_bits: index_bits(u64::from(minimum_at) + 1),
        thresholds,
        scores,
        has_summary: array.periphery().is_some(),
        head,
        pins,
        divisor: board.baud_divisor(),
        blink: blink_bit(board.clock.core_mhz * 1_000_000 / timing.cycles_per_frame),
    })
}

/// Returns the bit of the frame counter that changes about twice per second.
fn blink_bit(fps: u32) -> u32 {
    fps.max(2).ilog2() - 1
}

/// Returns the running sum over regions after each of the first `frames` frames of the pattern.
pub(crate) fn signature_sums(array: PipelinedDesign<'_>, frames: u32) -> Vec<u32> {
    let (scores, mut engine) = (score_ports(&array), Engine::new(&array));
    let mut sum = 0_u32;
    let mut add = |number: u32| {
        let frame = pattern_frame(array.width(), array.height(), number);
        if engine.step_byte_frame(&frame).is_err() {
            unreachable!("a frame of the pattern fits its design");
        }
        for region in 0..array.regions() {
            let bytes = signed_bytes(&array, &scores, &engine, (number, region));
            sum = sum.wrapping_add(crc32fast::hash(&bytes));
        }
        sum
    };
    (0..frames).map(&mut add).collect()
}

/// Returns the bytes that the signature of a region covers, for the frame that the engine has just
/// taken.
fn signed_bytes(
    design: &Design,
    scores: &[ScorePort],
    engine: &Engine,
    (frame, region): (u32, u32),
) -> Vec<u8> {
    let (outcome, at) = (engine.outcome(), region as usize);
    let action = outcome.actions[at];
    let bits =
        [outcome.srs[at], outcome.trs[at], action == RegionAction::Summarize, outcome.active[at]];
    let decision: u8 = (0_u32..).zip(bits).map(|(bit, value)| u8::from(value) << bit).sum();
    let mut bytes = region.to_le_bytes().to_vec();
    bytes.push(decision);
    for score in scores {
        let value = match score.kind {
            None => outcome.temporal_count[at].into(),
            Some(kind) => {
                let feature_index =
                    design.features().iter().position(|feature| feature.kind() == kind);
                feature_index.map_or(0, |feature_index| outcome.scores[feature_index][at])
            }
        };
        bytes.extend(&value.to_le_bytes()[..score.byte_count() as usize]);
    }
    let mut values = Vec::new();
    match (action, design.payload()) {
        (RegionAction::Summarize, _) => engine.summary(region, &mut values),
        (RegionAction::Forward, Payload::Denoised) => engine.denoised_region(region, &mut values),
        (RegionAction::Forward, Payload::Raw) => values = pattern_region(design, frame, region),
        (RegionAction::Hold | RegionAction::Blank, _) => {}
    }
    // All pixels have 8 bits.
    bytes.extend(values.iter().map(|value| u8::try_from(*value).unwrap_or(u8::MAX)));
    bytes
}

/// Returns the pixels of the pattern in a region.
fn pattern_region(design: &Design, frame: u32, region: u32) -> Vec<u16> {
    let side = design.region_size();
    let (left, top) = (region % design.columns() * side, region / design.columns() * side);
    let places = (top..top + side).flat_map(|y| (left..left + side).map(move |x| (x, y)));
    places.map(|(x, y)| crate::pattern::pattern_pixel(x, y, frame).into()).collect()
}
