// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate check`: the derived card of a design.

use std::fmt::Write;

use foveate_spec::{Config, Design, Direction, Neighborhood, Port, Timing};
use serde::Serialize;

use crate::args::{CheckArgs, DesignArgs};
use crate::error::CliError;
use crate::output;

/// Everything that follows from a configuration.
#[derive(Serialize)]
struct Card<'a> {
    format_version: u32,
    fingerprint: String,
    config: &'a Config,
    grid: Grid,
    pixel_max: u32,
    region_pixels: u32,
    stream: Stream,
    features: Vec<Feature>,
    count_bits: u32,
    timing: Clocks,
    rpu_ports: Vec<PortRow>,
    rcm_ports: Vec<PortRow>,
}

#[derive(Serialize)]
struct Grid {
    columns: u32,
    rows: u32,
    regions: u32,
}

#[derive(Serialize)]
struct Stream {
    halo: u32,
    side: u32,
    pixels: u32,
}

#[derive(Serialize)]
struct Feature {
    feature: &'static str,
    level: Option<u32>,
    level_bits: Option<u32>,
    min_score: u64,
    score_max: u64,
    score_bits: u32,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Clocks {
    Pipelined(Latencies),
    Serial { cycles_per_frame: u64 },
}

#[derive(Serialize)]
struct Latencies {
    cycles_per_frame: u32,
    decision_latency: u32,
    decision_frames: u32,
    forward_frames: u32,
}

#[derive(Serialize)]
struct PortRow {
    name: String,
    direction: &'static str,
    width: u32,
    lanes: u32,
    doc: String,
}

pub(crate) fn run(args: &CheckArgs) -> Result<(), CliError> {
    let source = DesignArgs {
        config: args.file.clone().or_else(|| args.design.config.clone()),
        preset: args.design.preset.clone(),
        overrides: args.design.overrides.clone(),
    };
    let design = source.design()?;
    let card = Card::of(&design);
    if args.json { output::json(&card) } else { output::text(&text(&design, &card)) }
}

impl<'a> Card<'a> {
    fn of(design: &'a Design) -> Self {
        Self {
            format_version: 1,
            fingerprint: design.fingerprint(),
            config: design.config(),
            grid: Grid {
                columns: design.columns(),
                rows: design.rows(),
                regions: design.regions(),
            },
            pixel_max: design.pixel_max(),
            region_pixels: design.region_pixels(),
            stream: Stream {
                halo: design.halo(),
                side: design.stream_side(),
                pixels: design.stream_pixels(),
            },
            features: design.features().iter().map(Feature::of).collect(),
            count_bits: design.count_bits(),
            timing: match design.timing() {
                Timing::Pipelined(timing) => Clocks::Pipelined(Latencies {
                    cycles_per_frame: timing.cycles_per_frame,
                    decision_latency: timing.decision_latency,
                    decision_frames: timing.decision_frames,
                    forward_frames: timing.forward_frames,
                }),
                Timing::Serial(timing) => {
                    Clocks::Serial { cycles_per_frame: timing.clocks_per_frame() }
                }
            },
            rpu_ports: design.rpu_ports().iter().map(PortRow::of).collect(),
            rcm_ports: design.rcm_ports().iter().map(PortRow::of).collect(),
        }
    }
}

impl Feature {
    fn of(feature: &foveate_spec::SpatialFeature) -> Self {
        Self {
            feature: feature.kind().name(),
            level: feature.level(),
            level_bits: feature.level().map(|_| feature.level_bits()),
            min_score: feature.min_score(),
            score_max: feature.score_max(),
            score_bits: feature.score_bits(),
        }
    }
}

impl PortRow {
    fn of(port: &Port) -> Self {
        Self {
            name: port.name.clone(),
            direction: match port.direction {
                Direction::Input => "input",
                Direction::Output => "output",
            },
            width: port.width,
            lanes: port.lanes,
            doc: port.doc.clone(),
        }
    }
}

fn text(design: &Design, card: &Card<'_>) -> String {
    let mut lines = vec![
        ("design", card.fingerprint.clone()),
        (
            "frame",
            format!(
                "{} x {} pixels, {} bits",
                design.width(),
                design.height(),
                design.pixel_bits()
            ),
        ),
        (
            "grid",
            format!(
                "{} x {} = {} regions of {}x{}",
                card.grid.columns,
                card.grid.rows,
                card.grid.regions,
                design.region_size(),
                design.region_size()
            ),
        ),
        ("filter", format!("{}, {} neighborhood", design.filter(), design.neighborhood())),
    ];
    for feature in &card.features {
        lines.push((feature.feature, feature_line(feature)));
    }
    lines.push(("temporal", temporal_line(design)));
    lines.push(("SRS", format!("{} of the features", design.combine())));
    lines.push(("stream", stream_line(design, card)));
    match &card.timing {
        Clocks::Pipelined(timing) => {
            lines.push(("cycles per frame", timing.cycles_per_frame.to_string()));
            lines.push(("decision", decision_line(timing)));
            lines.push(("pixels leave", forward_line(timing)));
        }
        Clocks::Serial { cycles_per_frame } => {
            lines.push(("cycles per frame", cycles_per_frame.to_string()));
        }
    }
    let mut text = String::new();
    for (name, value) in lines {
        let start = format!("{name:<17} ");
        wrap(&mut text, &start, &value);
    }
    ports(&mut text, "rpu", &card.rpu_ports);
    ports(&mut text, "rcm", &card.rcm_ports);
    text
}

fn feature_line(feature: &Feature) -> String {
    let level = feature.level.map(|level| format!("level {level}, ")).unwrap_or_default();
    format!(
        "{level}votes from {} on; scores 0..={}, {} bits",
        feature.min_score, feature.score_max, feature.score_bits
    )
}

fn temporal_line(design: &Design) -> String {
    let temporal = design.temporal();
    format!(
        "level {}, TRS from {} on, against {}; counts 0..={}, {} bits",
        temporal.level,
        temporal.min_count,
        temporal.reference,
        design.region_pixels(),
        design.count_bits()
    )
}

fn stream_line(design: &Design, card: &Card<'_>) -> String {
    let halo = match design.neighborhood() {
        Neighborhood::Isolated => String::new(),
        Neighborhood::Shared => format!(", halo {} included", card.stream.halo),
    };
    format!("{0} x {0} = {1} pixels per region{halo}", card.stream.side, card.stream.pixels)
}

fn decision_line(timing: &Latencies) -> String {
    let of = if timing.decision_frames == 0 { "" } else { " of the next frame" };
    format!("valid {} clocks after the last pixel{of}", timing.decision_latency)
}

fn forward_line(timing: &Latencies) -> String {
    let which = if timing.forward_frames == 1 { "next frame" } else { "next frame but one" };
    format!("while the {which} enters")
}

fn ports(text: &mut String, module: &str, rows: &[PortRow]) {
    let _ = writeln!(text, "\nports of {module}");
    for row in rows {
        let lanes = if row.lanes == 1 { String::new() } else { format!("{} x ", row.lanes) };
        let bits = format!("{lanes}{}", row.width);
        let start = format!("  {:<6} {bits:>10}  {:<17} ", row.direction, row.name);
        wrap(text, &start, &row.doc);
    }
}

/// A line that starts with `start`; what does not fit goes on under `rest`.
fn wrap(text: &mut String, start: &str, rest: &str) {
    let indent = " ".repeat(start.len());
    let options = textwrap::Options::new(output::width())
        .initial_indent(start)
        .subsequent_indent(&indent)
        .break_words(false);
    let _ = writeln!(text, "{}", textwrap::fill(rest, options));
}
