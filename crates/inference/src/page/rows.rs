// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clips, layers, frames and tuning trials, as rows of tables and as texts of marks.

use super::figures::{bytes, decibels, error, many, mean_bytes, millijoules, milliseconds, share};
use crate::charts::{self, frame_id, layer_id};
use crate::facts::{CLIPS, Column as Fact, FRAMES, LAYERS, TRIED, Value, shape};
use crate::frame::Frame;
use crate::{Layer, Summary};
use foveate_pictures::page::number::real;
use foveate_pictures::page::{Cell, Column, Row, Table};
use std::collections::BTreeMap;

/// The rows of a table, and the text of the mark of each row.
pub(super) struct Rows {
    columns: Vec<Column>,
    rows: Vec<Row>,
    titles: Vec<String>,
}

/// A row: its id, its number, its content, whether the content has counted frames, and the text of
/// its mark.
type Of<T> = (String, u64, T, bool, String);

impl Rows {
    /// Creates a table of the columns with these keys, in this order.
    fn new<'a, T: 'a>(
        facts: &[Fact<T>],
        keys: &[&str],
        of: impl Iterator<Item = Of<&'a T>>,
    ) -> Self {
        let named = |key: &&str| facts.iter().find(|fact| fact.heading.key == *key);
        let facts: Vec<_> =
            keys.iter().map(|key| named(key).expect("a column of the list")).collect();
        let column = |fact: &&Fact<T>| Column {
            name: fact.heading.name.to_owned(),
            unit: fact.heading.unit,
            title: fact.heading.meaning.to_owned(),
            numbers: fact.numbers,
        };
        let mut rows =
            Self { columns: facts.iter().map(column).collect(), rows: vec![], titles: vec![] };
        for (id, number, of, is_counted, title) in of {
            // Without a counted frame there are no shares.
            let is_told = |fact: &Fact<T>| is_counted || !fact.is_mean;
            let cell =
                |fact: &&Fact<T>| if is_told(fact) { cell((fact.value)(of)) } else { Cell::none() };
            rows.rows.push(Row {
                id,
                number,
                best: false,
                cells: facts.iter().map(cell).collect(),
            });
            rows.titles.push(title);
        }
        rows
    }

    /// Returns the texts of all marks by id.
    pub(super) fn titles(&self) -> BTreeMap<&str, &str> {
        self.rows.iter().zip(&self.titles).map(|(row, title)| (&row.id[..], &title[..])).collect()
    }

    pub(super) fn table(&self, number: &'static str) -> Table<'_> {
        let rows = self.rows.iter().collect();
        Table {
            prefix: "p",
            number,
            link: "",
            tall: true,
            marks_best: false,
            columns: &self.columns,
            rows,
        }
    }
}

/// Formats a value for the page.
fn cell(value: Value) -> Cell {
    let number = |value: Option<f64>, text: fn(f64) -> String| {
        value.map_or_else(Cell::none, |value| Cell::number(text(value), Some(value)))
    };
    match value {
        Value::Words(words) => Cell::words(words),
        Value::Shape(lengths) => Cell::words(shape(&lengths, "×")),
        Value::Flag(flag) => Cell::words(if flag { "yes" } else { "no" }.to_owned()),
        Value::Holds(holds) => Cell::words(reached(holds).to_owned()),
        Value::Count(count) => Cell::count(count),
        Value::Share(share) => Cell::share(share),
        Value::Real(None, _) => Cell::none(),
        Value::Real(Some(value), digits) => Cell::number(real(value, digits), Some(value)),
        Value::Milliseconds(seconds, digits) => cell(Value::Real(Some(1e3 * seconds), digits)),
        Value::Error(value) => number(value, error),
        Value::Limit(value) => number(value, limit),
        // Equal outputs are the best.
        Value::Psnr(None) => Cell { text: "=".to_owned(), sort: "1e9".to_owned(), class: "number" },
        Value::Psnr(psnr) => cell(Value::Real(psnr, 1)),
    }
}

/// Returns a row per clip.
pub(super) fn clips(summary: &Summary) -> Rows {
    let keys = ["clip", "frames", "counted", "active", "changed", "needed", "computed", "problem"];
    let rows = (0..).zip(&summary.clips).map(|(number, clip)| {
        (format!("c{number}"), number, clip, clip.counted_frames > 0, String::new())
    });
    Rows::new(CLIPS, &keys, rows)
}

/// Returns a row per layer.
pub(super) fn layers(summary: &Summary) -> Rows {
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
    Rows::new(LAYERS, &keys, summary.layers.iter().enumerate().map(row))
}

fn layer_title(number: usize, layer: &Layer) -> String {
    let traffic = layer.traffic;
    let mut title = format!(
        "Layer {number}: {} ({}), {}\n{} needed, {} computed, {} passed on\n{} MACs, weights {}, output {}\nread {}, of it halo {}, written {}",
        layer.name,
        layer.operator,
        shape(&layer.shape, "×"),
        share(layer.needed_share),
        share(layer.scheduled_share),
        share(layer.changed_share),
        many(real_of(layer.macs)),
        bytes(layer.weight_bytes),
        bytes(layer.output_bytes),
        mean_bytes(traffic.read_bytes),
        mean_bytes(traffic.halo_bytes),
        mean_bytes(traffic.written_bytes)
    );
    if let Some((masked, whole)) = layer.masked_cost.zip(layer.whole_cost) {
        title += &format!(
            "\n{} cycles and {}; whole {} and {}",
            real(masked.cycles, 0),
            millijoules(masked.energy_mj),
            real(whole.cycles, 0),
            millijoules(whole.energy_mj)
        );
    }
    if let Some(relative) = layer.relative_rms {
        title += &format!("\nrelative RMS error {}", error(relative));
    }
    title
}

/// Returns a row per frame that is shown.
pub(super) fn frames(frames: &[&Frame], summary: &Summary) -> Rows {
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
        let wrong = frame.relative_rms.map_or_else(String::new, error);
        let title = format!(
            "Frame {}{clip}: {}\n{} of the MACs needed, {} computed\n{} of the regions changed, {} active\n{}{}",
            frame.number,
            frame.name,
            share(frame.macs.needed_share()),
            share(frame.macs.scheduled_share()),
            share(frame.changed),
            share(frame.active),
            milliseconds(frame.seconds),
            if compared { format!(", relative RMS error {wrong}") } else { String::new() }
        );
        (frame_id(frame.place), frame.number, frame, true, title)
    });
    Rows::new(FRAMES, &keys, rows)
}

/// Returns a row per trial of tuning.
pub(super) fn tried(summary: &Summary) -> Rows {
    let mut keys = vec!["limits", "relative_limit", "needed_share", "rms_of_variation"];
    keys.extend(["relative_rms", "largest", "agreement", "cosine", "psnr", "holds"]);
    let all = summary.tuning.as_ref().map(charts::tried).unwrap_or_default();
    let rows = (0..).zip(&all).map(|(number, (id, attempt))| {
        let (limits, tried) = attempt;
        let found = &tried.outputs;
        let relative = tried.relative_limit.filter(|&limit| limit > 0.0);
        let relative =
            relative.map_or_else(String::new, |limit| format!(", relative limit {limit}"));
        let title = format!(
            "Limits: {limits}{relative}\n{} of the MACs needed, goal {}\nerror {} of the variation, cosine {}, PSNR {}, agreement {}",
            share(tried.needed_share),
            reached(tried.holds),
            share(found.rms_of_variation),
            real(found.cosine, 6),
            decibels(found.psnr),
            share(found.agreement)
        );
        (id.clone(), number, attempt, true, title)
    });
    Rows::new(TRIED, &keys, rows)
}

fn reached(holds: bool) -> &'static str {
    if holds { "reached" } else { "missed" }
}

fn limit(value: f64) -> String {
    // Only the limit of a layer that never passes anything on is infinite.
    match value {
        f64::INFINITY => "infinite".to_owned(),
        0.01.. => real(value, 3),
        _ => error(value),
    }
}

#[allow(clippy::cast_precision_loss, reason = "shown with four digits")]
fn real_of(count: u64) -> f64 {
    count as f64
}
