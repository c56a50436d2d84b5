// SPDX-License-Identifier: MIT OR Apache-2.0
//! Layers, frames and what tuning tried, as rows of tables and as what a mark says.

mod clips;

use super::figures::{bytes, decibels, error, many, mean_bytes, millijoules, milliseconds, share};
use crate::charts::{self, Counted, frame_id, layer_id};
use crate::{FrameCost, Layer, Summary};
use foveate_pictures::page::number::real;
use foveate_pictures::page::{Cell, Column, Row, Table};
use std::collections::BTreeMap;

pub(super) use clips::clips;

/// Rows, and the figures of each in a few lines.
pub(super) struct Rows {
    columns: Vec<Column>,
    rows: Vec<Row>,
    titles: Vec<String>,
}

/// A column: its name, unit and meaning, and whether it holds numbers.
type Heading = (&'static str, &'static str, &'static str, bool);

impl Rows {
    fn new(headings: Vec<Heading>) -> Self {
        let column = |(name, unit, title, numbers): Heading| Column {
            name: name.to_owned(),
            unit,
            title: title.to_owned(),
            numbers,
        };
        let columns = headings.into_iter().map(column).collect();
        Self { columns, rows: Vec::new(), titles: Vec::new() }
    }

    fn push(&mut self, id: String, number: u64, cells: Vec<Cell>, title: String) {
        self.rows.push(Row { id, number, best: false, cells });
        self.titles.push(title);
    }

    /// What a mark says, by id.
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

/// A row per layer.
pub(super) fn layers(summary: &Summary) -> Rows {
    let (costs, compared) = (summary.accelerator.is_some(), summary.error.is_some());
    let cut = summary.layers.iter().any(|layer| layer.limit.is_some());
    let is_counted = summary.counted_frames > 0;
    let mut headings = vec![
        ("name", "", "name of the node in the model", false),
        ("operator", "", "what it computes; + stands before an activation of the same node", false),
        ("output", "", "shape of the output", false),
        ("MACs", "", "multiplications and additions for a whole frame", true),
        ("needed", "%", "positions whose windows hold a change", true),
        ("computed", "%", "positions that were computed, in whole blocks", true),
        ("passed on", "%", "positions that were passed on as changed", true),
        ("weights", "bytes", "bytes of the weights", true),
        ("output", "bytes", "bytes of the output, which stays from frame to frame", true),
        ("time", "ms", "per frame, on this computer", true),
    ];
    if costs {
        headings.extend([
            ("cycles", "masked", "cycles per frame on the accelerator, where the masks say", true),
            ("cycles", "whole", "cycles of a whole frame on the accelerator", true),
            (
                "energy",
                "mJ, masked",
                "energy per frame on the accelerator, where the masks say",
                true,
            ),
            ("energy", "mJ, whole", "energy of a whole frame on the accelerator", true),
        ]);
    }
    if cut {
        headings.push(("limit", "", "changes up to this are not passed on", true));
    }
    if compared {
        headings.push(("error", "", "relative RMS difference from a whole computation", true));
    }
    let mut rows = Rows::new(headings);
    for (number, layer) in summary.layers.iter().enumerate() {
        // Of no frame there are no shares.
        let counted = |cell: Cell| if is_counted { cell } else { Cell::none() };
        let mut cells = vec![
            Cell::words(layer.name.clone()),
            Cell::words(layer.operator.clone()),
            Cell::words(shape(layer)),
            Cell::count(layer.macs),
            counted(Cell::share(layer.needed_share)),
            counted(Cell::share(layer.scheduled_share)),
            counted(Cell::share(layer.changed_share)),
            Cell::count(layer.weight_bytes),
            Cell::count(layer.output_bytes),
        ];
        let milliseconds = 1e3 * layer.traffic.seconds;
        cells.push(counted(Cell::number(real(milliseconds, 3), Some(milliseconds))));
        if costs {
            let of = |cost: Option<FrameCost>, value: fn(&FrameCost) -> f64, digits: usize| {
                let value = cost.as_ref().map(value);
                value
                    .map_or_else(Cell::none, |value| Cell::number(real(value, digits), Some(value)))
            };
            cells.extend([
                counted(of(layer.masked_cost, |cost| cost.cycles, 0)),
                of(layer.whole_cost, |cost| cost.cycles, 0),
                counted(of(layer.masked_cost, |cost| cost.energy_mj, 4)),
                of(layer.whole_cost, |cost| cost.energy_mj, 4),
            ]);
        }
        if cut {
            cells.push(limit(layer.limit.map(f64::from)));
        }
        if compared {
            cells.push(counted(wrong(layer.relative_rms)));
        }
        rows.push(layer_id(number), number as u64, cells, layer_title(number, layer));
    }
    rows
}

fn layer_title(number: usize, layer: &Layer) -> String {
    let traffic = layer.traffic;
    let mut title = format!(
        "Layer {number}: {} ({}), {}\n{} needed, {} computed, {} passed on\n{} MACs, weights {}, output {}\nread {}, of it halo {}, written {}",
        layer.name,
        layer.operator,
        shape(layer),
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

/// A row per frame that is shown.
pub(super) fn frames(frames: &[Counted], summary: &Summary) -> Rows {
    let (compared, several) = (summary.error.is_some(), summary.clips.len() > 1);
    let mut headings = vec![
        ("name", "", "the frame in its input", false),
        ("active", "% of regions", "regions that were active", true),
        ("changed", "% of regions", "regions whose rendered pixels changed", true),
        ("needed", "% of MACs", "MACs whose windows hold a change", true),
        ("computed", "% of MACs", "MACs that were computed, in whole blocks", true),
        ("time", "ms", "time of the frame on this computer", true),
    ];
    if compared {
        headings.push((
            "error",
            "",
            "relative RMS difference of the outputs from a whole computation",
            true,
        ));
    }
    if several {
        headings.insert(0, ("clip", "", "the clip or set of the frame", false));
    }
    let mut rows = Rows::new(headings);
    for frame in frames {
        let of = |macs| frame.macs.share(macs);
        let mut cells = vec![
            Cell::words(frame.name.clone()),
            Cell::share(frame.active),
            Cell::share(frame.changed),
            Cell::share(of(frame.macs.needed)),
            Cell::share(of(frame.macs.scheduled)),
            Cell::number(real(1e3 * frame.seconds, 2), Some(frame.seconds)),
        ];
        let clip = if several { format!(" of {}", frame.clip) } else { String::new() };
        if several {
            cells.insert(0, Cell::words(frame.clip.clone()));
        }
        let mut title = format!(
            "Frame {}{clip}: {}\n{} of the MACs needed, {} computed\n{} of the regions changed, {} active\n{}",
            frame.number,
            frame.name,
            share(of(frame.macs.needed)),
            share(of(frame.macs.scheduled)),
            share(frame.changed),
            share(frame.active),
            milliseconds(frame.seconds)
        );
        if compared {
            cells.push(wrong(frame.relative_rms));
            title += &format!(
                ", relative RMS error {}",
                frame.relative_rms.map_or_else(String::new, error)
            );
        }
        rows.push(frame_id(frame.place), frame.number, cells, title);
    }
    rows
}

/// A row for everything that tuning tried.
pub(super) fn tried(summary: &Summary) -> Rows {
    let mut rows = Rows::new(vec![
        (
            "limits",
            "",
            "exact: limits of 0; uniform: one relative limit; frozen: nothing after the first frame; chosen",
            false,
        ),
        (
            "relative limit",
            "",
            "share of the root mean square of each layer's values, if it is one for all",
            true,
        ),
        ("needed", "% of MACs", "MACs whose windows hold a change", true),
        (
            "error",
            "% of variation",
            "RMS error of the outputs, as a share of their standard deviation over the frames of their clip",
            true,
        ),
        ("error", "relative", "relative RMS error of the outputs", true),
        ("largest", "", "largest difference of an output", true),
        (
            "agreement",
            "% of frames",
            "frames in which every output has its largest value at the same place",
            true,
        ),
        (
            "cosine",
            "",
            "cosine of the angle between all outputs and those of a whole computation",
            true,
        ),
        ("PSNR", "dB", "of all outputs; = means equal", true),
        ("goal", "", "whether it is reached", false),
    ]);
    let Some(tuning) = &summary.tuning else { return rows };
    for (number, (id, limits, tried)) in (0..).zip(charts::tried(tuning)) {
        let found = &tried.outputs;
        let holds = if tried.holds { "reached" } else { "missed" };
        let psnr = match found.psnr {
            Some(psnr) => Cell::number(real(psnr, 1), Some(psnr)),
            // Equal outputs are the best.
            None => Cell { text: "=".to_owned(), sort: "1e9".to_owned(), class: "number" },
        };
        let cells = vec![
            Cell::words(limits.to_owned()),
            limit(tried.relative_limit),
            Cell::share(tried.needed_share),
            Cell::share(found.rms_of_variation),
            wrong(Some(found.relative_rms)),
            wrong(Some(found.largest)),
            Cell::share(found.agreement),
            Cell::number(real(found.cosine, 6), Some(found.cosine)),
            psnr,
            Cell::words(holds.to_owned()),
        ];
        let relative = tried.relative_limit.filter(|&limit| limit > 0.0);
        let relative =
            relative.map_or_else(String::new, |limit| format!(", relative limit {limit}"));
        let title = format!(
            "Limits: {limits}{relative}\n{} of the MACs needed, goal {holds}\nerror {} of the variation, cosine {}, PSNR {}, agreement {}",
            share(tried.needed_share),
            share(found.rms_of_variation),
            real(found.cosine, 6),
            decibels(found.psnr),
            share(found.agreement)
        );
        rows.push(id, number, cells, title);
    }
    rows
}

fn shape(layer: &Layer) -> String {
    layer.shape.iter().map(ToString::to_string).collect::<Vec<_>>().join("×")
}

fn wrong(value: Option<f64>) -> Cell {
    value.map_or_else(Cell::none, |value| Cell::number(error(value), Some(value)))
}

fn limit(value: Option<f64>) -> Cell {
    value.map_or_else(Cell::none, |value| {
        // Nothing is infinite but the limit of what is never passed on.
        let text = match value {
            f64::INFINITY => "infinite".to_owned(),
            0.01.. => real(value, 3),
            _ => error(value),
        };
        Cell::number(text, Some(value))
    })
}

#[allow(clippy::cast_precision_loss, reason = "shown with four digits")]
fn real_of(count: u64) -> f64 {
    count as f64
}
