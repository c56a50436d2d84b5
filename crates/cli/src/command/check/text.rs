// SPDX-License-Identifier: MIT OR Apache-2.0
//! The card as text.

use std::fmt::Write;

use foveate_camera::{Neighborhood, Periphery, RegionClass};
use foveate_design::{Design, Hardware, RasterDesign, RasterMemory};

use super::array::{LaneArray, LaneMemoryFigures};
use super::card::{DesignCard, FeatureRow, PortRow};
use super::clip::clip_lines;
use crate::output;

pub(super) fn text(design: &Design, card: &DesignCard) -> String {
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
    lines.extend(design.periphery().map(|own| ("periphery", periphery_line(own))));
    lines.extend(zone_lines(design));
    lines.push(("organization", design.config().hardware.description()));
    match design.hardware() {
        Hardware::Raster(own) => {
            let core = design.with_hardware(own);
            lines.push(("stream", raster_stream_line(core.pixels_per_clock())));
            lines.push(("memory", raster_memory_line(core)));
        }
        Hardware::Pipelined(_) | Hardware::Serial(_) => {
            lines.push(("stream", stream_line(design, card)));
        }
    }
    if let Some(array) = &card.array {
        lines.push(("lanes", lanes_line(array)));
        lines.push(("lane memory", memory_line(design, &array.memory)));
    }
    lines.extend(card.timing.0.descriptions().iter().cloned());
    lines.extend(card.rate.iter().map(|rate| ("rate", rate.text.clone())));
    lines.extend(card.needs.iter().map(|needed| ("rate", needed.text.clone())));
    if let Some(proposal) = &card.proposal {
        lines.push(("proposal", proposal.text.clone()));
    }
    lines.extend(card.clip.iter().flat_map(clip_lines));
    let mut text = String::new();
    for (name, value) in lines {
        let start = format!("{name:<17} ");
        push_wrapped(&mut text, &start, &value);
    }
    push_ports(&mut text, "rpu", &card.rpu_ports);
    push_ports(&mut text, "rcm", &card.rcm_ports);
    text
}

fn feature_line(feature: &FeatureRow) -> String {
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

fn periphery_line(own: &Periphery) -> String {
    let (blocks, side) = (own.blocks, own.block_side);
    let means = match blocks {
        1 => format!("the mean of {side}x{side} pixels"),
        _ => format!("the means of {blocks}x{blocks} blocks of {side}x{side} pixels"),
    };
    format!("{means} where SRS is 0, sent again when one differs by more than {}", own.level)
}

/// Returns the lines about zones: the regions of each class, and the thresholds that differ from
/// those of normal regions.
fn zone_lines(design: &Design) -> Vec<(&'static str, String)> {
    let Some(zones) = design.zones() else { return Vec::new() };
    let classes = zones.configured_classes();
    let count = |class| classes.iter().filter(|&&own| own == class).count();
    let counts = RegionClass::ALL.iter().map(|&class| format!("{} {class}", count(class)));
    let mut lines = vec![("zones", counts.collect::<Vec<_>>().join(", ") + " regions")];
    let (own, keen) =
        (design.class_thresholds(RegionClass::Normal), design.class_thresholds(RegionClass::Keen));
    let mut differences = Vec::new();
    for (own, keen) in own.features.iter().zip(keen.features) {
        let kind = keen.kind();
        if let (Some(level), true) = (keen.level(), keen.level() != own.level()) {
            differences.push(format!("{kind} level {level}"));
        }
        if keen.min_score() != own.min_score() {
            differences.push(format!("{kind} votes from {} on", keen.min_score()));
        }
    }
    if keen.temporal_level != own.temporal_level {
        differences.push(format!("temporal level {}", keen.temporal_level));
    }
    if keen.min_count != own.min_count {
        differences.push(format!("TRS from {} on", keen.min_count));
    }
    if let (Some(level), true) = (keen.summary_level, keen.summary_level != own.summary_level) {
        differences.push(format!("means differ by more than {level}"));
    }
    lines.push((
        "keen",
        match differences.is_empty() {
            true => "the thresholds of normal regions".to_owned(),
            false => differences.join(", "),
        },
    ));
    if let Some(level) = design.class_thresholds(RegionClass::Off).summary_level {
        lines.push(("off", format!("means are sent again when one differs by more than {level}")));
    }
    lines
}

fn stream_line(design: &Design, card: &DesignCard) -> String {
    let halo = match design.neighborhood() {
        Neighborhood::Isolated => String::new(),
        Neighborhood::Shared => format!(", halo {} included", card.stream.halo),
    };
    format!("{0} x {0} = {1} pixels per region{halo}", card.stream.side, card.stream.pixels)
}

/// Returns the line about the stream of a core that takes the frame row by row (`raster`).
fn raster_stream_line(pixels: u32) -> String {
    let word = if pixels == 1 { "pixel".to_owned() } else { format!("word of {pixels} pixels") };
    format!("the frame row by row, a {word} per clock")
}

fn raster_memory_line(design: RasterDesign<'_>) -> String {
    let memories = RasterMemory::all_memories(design);
    let bits = memories.iter().map(RasterMemory::total_bits).sum::<u64>();
    match RasterMemory::frame_store(design) {
        Some(store) => format!("{bits} bits, {} of them references", store.total_bits()),
        None => format!("{bits} bits, and references outside of the core"),
    }
}

fn lanes_line(array: &LaneArray) -> String {
    let each = if array.fold == 1 { "region" } else { "regions" };
    format!("{}, {} {each} each, {} feed", array.lanes, array.fold, array.feed)
}

fn memory_line(design: &Design, memory: &LaneMemoryFigures) -> String {
    let areas = memory.areas.iter().map(|row| format!("{0} {1}x{1}", row.area, row.side));
    format!(
        "{} words of {} bits, {} per slot for {}; {} ({})",
        memory.words,
        design.pixel_bits(),
        memory.slot_words,
        areas.collect::<Vec<_>>().join(", "),
        memory.kind,
        memory.why
    )
}

fn push_ports(text: &mut String, module: &str, rows: &[PortRow]) {
    /// The width of names, unless one is longer.
    const NAME_WIDTH: usize = 18;
    let longest = rows.iter().map(|row| row.name.len()).max().unwrap_or_default();
    let width = longest.max(NAME_WIDTH);
    let _ = writeln!(text, "\nports of {module}");
    for row in rows {
        let lanes = if row.lanes == 1 { String::new() } else { format!("{} x ", row.lanes) };
        let bits = format!("{lanes}{}", row.width);
        let start = format!("  {:<6} {bits:>10}  {:<width$} ", row.direction, row.name);
        push_wrapped(text, &start, &row.doc);
    }
}

/// Appends `start` and `rest`. Lines that do not fit go on below the beginning of `rest`.
fn push_wrapped(text: &mut String, start: &str, rest: &str) {
    let indent = " ".repeat(start.len());
    let options = textwrap::Options::new(output::text_width())
        .initial_indent(start)
        .subsequent_indent(&indent)
        .break_words(false);
    let _ = writeln!(text, "{}", textwrap::fill(rest, options));
}
