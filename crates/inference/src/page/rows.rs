// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clips, layers, frames and tuning trials, as rows of tables and as texts of marks.

use super::figures::{
    bytes_text, decibels_text, error_text, large_count_text, mean_bytes_text, millijoules_text,
    milliseconds_text, share_text,
};
use crate::charts::{self, frame_id, layer_id};
use crate::frame::FrameFigures;
use crate::table_columns::{
    CLIPS, FRAMES, FigureColumn as Fact, FigureValue, LAYERS, TRIALS, shape_text,
};
use crate::{InferenceSummary, LayerSummary};
use foveate_output::{
    number_text::real_number,
    page::{SortableTable, TableCell, TableColumn, TableRow},
};

/// A row: its id, its number, its content, whether the content has counted frames, and the text of
/// its mark.
type RowContent<T> = (String, u64, T, bool, String);

/// Creates a table of the columns with these keys, in this order. `number` is the meaning of the
/// numbers of its rows.
fn table<'a, T: 'a>(
    number: &'static str,
    facts: &[Fact<T>],
    keys: &[&str],
    rows: impl Iterator<Item = RowContent<&'a T>>,
) -> SortableTable {
    let named = |key: &&str| facts.iter().find(|fact| fact.heading.key == *key);
    let facts: Vec<_> = keys.iter().map(|key| named(key).expect("a column of the list")).collect();
    let column = |fact: &&Fact<T>| TableColumn {
        name: fact.heading.name.to_owned(),
        unit: fact.heading.unit,
        title: fact.heading.meaning.to_owned(),
        numbers: fact.numbers,
    };
    let row = |(id, number, of, is_counted, mark_title): RowContent<&T>| {
        // Without a counted frame there are no shares.
        let is_told = |fact: &Fact<T>| is_counted || !fact.is_mean;
        let cell = |fact: &&Fact<T>| {
            if is_told(fact) { cell((fact.value)(of)) } else { TableCell::missing() }
        };
        TableRow { id, number, best: false, cells: facts.iter().map(cell).collect(), mark_title }
    };
    SortableTable {
        prefix: "p",
        number,
        link: "",
        tall: true,
        marks_best: false,
        columns: facts.iter().map(column).collect(),
        rows: rows.map(row).collect(),
    }
}

/// Formats a value for the page.
fn cell(value: FigureValue) -> TableCell {
    let number = |value: Option<f64>, text: fn(f64) -> String| {
        value.map_or_else(TableCell::missing, |value| TableCell::number(text(value), Some(value)))
    };
    match value {
        FigureValue::Text(words) => TableCell::text(words),
        FigureValue::Shape(lengths) => TableCell::text(shape_text(&lengths, "×")),
        FigureValue::Flag(flag) => TableCell::text(if flag { "yes" } else { "no" }.to_owned()),
        FigureValue::GoalReached(holds) => TableCell::text(goal_text(holds).to_owned()),
        FigureValue::Count(count) => TableCell::count(count),
        FigureValue::Share(share) => TableCell::share(share),
        FigureValue::Real(None, _) => TableCell::missing(),
        FigureValue::Real(Some(value), digits) => {
            TableCell::number(real_number(value, digits), Some(value))
        }
        FigureValue::Milliseconds(seconds, digits) => {
            cell(FigureValue::Real(Some(1e3 * seconds), digits))
        }
        FigureValue::Error(value) => number(value, error_text),
        FigureValue::Limit(value) => number(value, limit_text),
        FigureValue::Psnr(psnr) => TableCell::psnr(psnr),
    }
}

pub(super) fn clips(summary: &InferenceSummary) -> SortableTable {
    let keys = ["clip", "frames", "counted", "active", "changed", "needed", "computed", "problem"];
    let rows = (0..).zip(&summary.clips).map(|(number, clip)| {
        (format!("c{number}"), number, clip, clip.counted_frames > 0, String::new())
    });
    table("number of the clip", CLIPS, &keys, rows)
}

pub(super) fn layers(summary: &InferenceSummary) -> SortableTable {
    let mut keys = vec!["name", "operator", "shape", "macs"];
    keys.extend(["needed_share", "scheduled_share", "changed_share"]);
    keys.extend(["weight_bytes", "output_bytes", "seconds"]);
    if summary.accelerator.is_some() {
        keys.extend(["cycles", "whole_cycles", "energy_mj", "whole_energy_mj"]);
    }
    if summary.layers.iter().any(|layer| layer.limit.is_some()) {
        keys.push("limit");
    }
    if summary.error.is_some() {
        keys.push("relative_rms");
    }
    let row = |(number, layer): (usize, _)| {
        let title = layer_title(number, layer);
        (layer_id(number), number as u64, layer, summary.counted_frames > 0, title)
    };
    table("number of the layer", LAYERS, &keys, summary.layers.iter().enumerate().map(row))
}

fn layer_title(number: usize, layer: &LayerSummary) -> String {
    let traffic = layer.traffic;
    let mut title = format!(
        "Layer {number}: {} ({}), {}\n{} needed, {} computed, {} passed on\n{} MACs, weights {}, output {}\nread {}, {} of it halo, written {}",
        layer.name,
        layer.operator,
        shape_text(&layer.shape, "×"),
        share_text(layer.needed_share),
        share_text(layer.scheduled_share),
        share_text(layer.changed_share),
        large_count_text(count_to_f64(layer.macs)),
        bytes_text(layer.weight_bytes),
        bytes_text(layer.output_bytes),
        mean_bytes_text(traffic.read_bytes),
        mean_bytes_text(traffic.halo_bytes),
        mean_bytes_text(traffic.written_bytes)
    );
    if let Some((masked, whole)) = layer.masked_cost.zip(layer.whole_cost) {
        title += &format!(
            "\n{} cycles and {}; whole {} and {}",
            real_number(masked.cycles, 0),
            millijoules_text(masked.energy_mj),
            real_number(whole.cycles, 0),
            millijoules_text(whole.energy_mj)
        );
    }
    if let Some(relative) = layer.relative_rms {
        title += &format!("\nrelative RMS error {}", error_text(relative));
    }
    title
}

/// Returns a row per frame that is shown.
pub(super) fn frames(frames: &[&FrameFigures], summary: &InferenceSummary) -> SortableTable {
    let (compared, several) = (summary.error.is_some(), summary.clips.len() > 1);
    let mut keys = if several { vec!["clip"] } else { Vec::new() };
    keys.extend(["name", "active_share", "changed_share", "needed_share", "scheduled_share"]);
    keys.push("seconds");
    if compared {
        keys.push("relative_rms");
    }
    if let Some(sight) = &summary.sight {
        keys.extend(["sent_bytes", "picture_psnr", "agreement"]);
        if sight.detections.is_some() {
            keys.extend(["whole_detections", "kept_detections", "added_detections"]);
        }
    }
    let rows = frames.iter().map(|&frame| {
        let clip = if several { format!(" of {}", frame.clip) } else { String::new() };
        let wrong = frame.relative_rms.map_or_else(String::new, error_text);
        let title = format!(
            "Frame {}{clip}: {}\n{} of the MACs needed, {} computed\n{} of the regions changed, {} active\n{}{}",
            frame.number,
            frame.name,
            share_text(frame.macs.needed_share()),
            share_text(frame.macs.scheduled_share()),
            share_text(frame.changed_share),
            share_text(frame.active_share),
            milliseconds_text(frame.seconds),
            if compared { format!(", relative RMS error {wrong}") } else { String::new() }
        );
        (frame_id(frame.index_in_run), frame.number, frame, true, title)
    });
    table("number of the frame", FRAMES, &keys, rows)
}

/// Returns a row per trial of tuning.
pub(super) fn trials(summary: &InferenceSummary) -> SortableTable {
    let mut keys = vec!["limits", "relative_limit", "needed_share", "rms_of_variation"];
    keys.extend(["relative_rms", "largest", "agreement", "cosine", "psnr", "holds"]);
    let all = summary.tuning.as_ref().map(charts::trials_with_ids).unwrap_or_default();
    let rows = (0..).zip(&all).map(|(number, (id, attempt))| {
        let (limits, tried) = attempt;
        let found = &tried.outputs;
        let relative = tried.relative_limit.filter(|&limit| limit > 0.0);
        let relative =
            relative.map_or_else(String::new, |limit| format!(", relative limit {limit}"));
        let title = format!(
            "Limits: {limits}{relative}\n{} of the MACs needed, goal {}\nerror {} of the variation, cosine {}, PSNR {}, agreement {}",
            share_text(tried.needed_share),
            goal_text(tried.holds),
            share_text(found.rms_of_variation),
            real_number(found.cosine, 6),
            decibels_text(found.psnr),
            share_text(found.agreement)
        );
        (id.clone(), number, attempt, true, title)
    });
    table("number of the run", TRIALS, &keys, rows)
}

fn goal_text(holds: bool) -> &'static str {
    if holds { "reached" } else { "missed" }
}

fn limit_text(value: f64) -> String {
    // Only the limit of a layer that never passes anything on is infinite.
    match value {
        f64::INFINITY => "infinite".to_owned(),
        0.01.. => real_number(value, 3),
        _ => error_text(value),
    }
}

#[allow(clippy::cast_precision_loss, reason = "shown with four digits")]
fn count_to_f64(count: u64) -> f64 {
    count as f64
}
