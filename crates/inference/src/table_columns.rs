// SPDX-License-Identifier: MIT OR Apache-2.0
//! The columns of the tables of clips, layers, frames and tuning trials. Each column is defined
//! once, for the files and for the page.

use crate::DetectionCounts;
use crate::LayerSummary;
use crate::frame::FrameFigures;
use crate::summary::{ClipSummary, TuningTrial};
use crate::whole_frames::DetectionRow;
use FigureValue::{
    Count, Error, Flag, GoalReached, Limit, Milliseconds, Psnr, Real, Shape, Share, Text,
};
use foveate_output::tables::{NamedCells, Table, TableCell};

/// A value of a column with its kind. The files and the page each format the kinds in their own
/// way.
pub(crate) enum FigureValue {
    Text(String),
    Shape(Vec<usize>),
    Flag(bool),
    /// True if a goal is reached.
    GoalReached(bool),
    Count(u64),
    /// A share from 0 to 1.
    Share(f64),
    /// A real number, and the number of digits that the page shows.
    Real(Option<f64>, usize),
    /// A time in seconds, and the number of digits with which the page shows it in milliseconds.
    Milliseconds(f64, usize),
    Error(Option<f64>),
    /// A limit; changes up to it are not passed on.
    Limit(Option<f64>),
    /// A peak signal-to-noise ratio in decibels; `None` for equal outputs, which are the best.
    Psnr(Option<f64>),
}

/// A column of a table with one `T` per row.
pub(crate) struct FigureColumn<T> {
    pub(crate) heading: ColumnHeading,
    pub(crate) value: fn(&T) -> FigureValue,
    /// True if the column holds numbers.
    pub(crate) numbers: bool,
    /// True if the column is a mean over the counted frames; it stays empty without a counted
    /// frame.
    pub(crate) is_mean: bool,
    is_in_files: bool,
}

/// The names of a column, its unit and its meaning.
pub(crate) struct ColumnHeading {
    /// The name in the files.
    pub(crate) key: &'static str,
    /// The name on the page.
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) meaning: &'static str,
}

/// Creates a heading from its name in the files, its name on the page, its unit and its meaning.
const fn heading(
    key: &'static str,
    name: &'static str,
    unit: &'static str,
    meaning: &'static str,
) -> ColumnHeading {
    ColumnHeading { key, name, unit, meaning }
}

/// Creates a column that only the files have.
const fn file_column<T>(key: &'static str, value: fn(&T) -> FigureValue) -> FigureColumn<T> {
    heading(key, "", "", "").number(value)
}

impl ColumnHeading {
    const fn number<T>(self, value: fn(&T) -> FigureValue) -> FigureColumn<T> {
        FigureColumn { heading: self, value, numbers: true, is_mean: false, is_in_files: true }
    }

    const fn mean<T>(self, value: fn(&T) -> FigureValue) -> FigureColumn<T> {
        FigureColumn { is_mean: true, ..self.number(value) }
    }

    const fn text<T>(self, value: fn(&T) -> FigureValue) -> FigureColumn<T> {
        FigureColumn { numbers: false, ..self.number(value) }
    }

    const fn page_number<T>(self, value: fn(&T) -> FigureValue) -> FigureColumn<T> {
        FigureColumn { is_in_files: false, ..self.number(value) }
    }
}

/// The meanings of columns that several tables share.
const ACTIVE: &str = "regions that were active";
const CHANGED: &str = "regions whose rendered pixels changed";
const NEEDED: &str = "MACs whose windows hold a change";
const COMPUTED: &str = "MACs that were computed, in whole blocks";
/// The units of columns that several tables share.
const REGIONS: &str = "% of regions";
const MACS: &str = "% of MACs";

/// Other meanings, which are too long for a line of a list.
const OPERATOR: &str = "operation of the layer; + precedes an activation of the same node";
const OUTPUT: &str = "bytes of the output, which stays from frame to frame";
const CYCLES: &str = "cycles per frame on the accelerator, which computes only where the masks say";
const ENERGY: &str = "energy per frame on the accelerator, which computes only where the masks say";
const DIFFERENCE: &str = "relative RMS difference of the outputs from a whole computation";
const RELATIVE_LIMIT: &str =
    "share of the root mean square of each layer's values, if all layers have the same share";
const AGREEMENT: &str = "frames in which every output has its largest value at the same place";
const COSINE: &str = "cosine of the angle between all outputs and those of a whole computation";
const LIMITS: &str = "exact: limits of 0; uniform: one relative limit; frozen: nothing after the first frame; chosen";
const SENT: &str = "bytes that the camera sends: two bits per region, displacements, pixels of active regions and means";
const PICTURE: &str = "PSNR of the receiver's screen against the whole frame";
const FINDINGS_AGREE: &str =
    "share of the network's outputs for the whole frame that are the same behind the camera";
const VARIATION: &str = "RMS error of the outputs, as a share of their standard deviation over the frames of their clip";

/// The columns of the table of clips, for the page.
pub(crate) const CLIPS: &[FigureColumn<ClipSummary>] = &[
    heading("clip", "clip", "", "the clip or set").text(|it| Text(it.name.clone())),
    heading("frames", "frames", "", "frames that the network has run on")
        .number(|it| Count(it.frames)),
    heading("counted", "counted", "", "frames that are in the means")
        .number(|it| Count(it.counted_frames)),
    heading("active", "active", REGIONS, ACTIVE).mean(|it| Share(it.active_share)),
    heading("changed", "changed", REGIONS, CHANGED).mean(|it| Share(it.changed_share)),
    heading("needed", "needed", MACS, NEEDED).mean(|it| Share(it.macs.needed_share())),
    heading("computed", "computed", MACS, COMPUTED).mean(|it| Share(it.macs.scheduled_share())),
    heading("problem", "problem", "", "why frames are missing")
        .text(|it| Text(it.problem.clone().unwrap_or_default())),
];

pub(crate) const LAYERS: &[FigureColumn<LayerSummary>] = &[
    heading("name", "name", "", "name of the node in the model").text(|it| Text(it.name.clone())),
    heading("operator", "operator", "", OPERATOR).text(|it| Text(it.operator.clone())),
    heading("shape", "output", "", "shape of the output").text(|it| Shape(it.shape.clone())),
    heading("macs", "MACs", "", "multiplications and additions for a whole frame")
        .number(|it| Count(it.macs)),
    heading("needed_share", "needed", "%", "positions whose windows hold a change")
        .mean(|it| Share(it.needed_share)),
    heading("scheduled_share", "computed", "%", "positions that were computed, in whole blocks")
        .mean(|it| Share(it.scheduled_share)),
    heading("changed_share", "passed on", "%", "positions that were passed on as changed")
        .mean(|it| Share(it.changed_share)),
    heading("weight_bytes", "weights", "bytes", "bytes of the weights")
        .number(|it| Count(it.weight_bytes)),
    heading("output_bytes", "output", "bytes", OUTPUT).number(|it| Count(it.output_bytes)),
    file_column("mask_bytes", |it| Count(it.mask_bytes)),
    file_column("read_bytes", |it| real(it.traffic.read_bytes)),
    file_column("halo_bytes", |it| real(it.traffic.halo_bytes)),
    file_column("written_bytes", |it| real(it.traffic.written_bytes)),
    heading("seconds", "time", "ms", "per frame, on this computer")
        .mean(|it| Milliseconds(it.traffic.seconds, 3)),
    heading("whole_cycles", "cycles", "whole", "cycles of a whole frame on the accelerator")
        .number(|it| Real(it.whole_cost.map(|cost| cost.cycles), 0)),
    heading("cycles", "cycles", "masked", CYCLES)
        .mean(|it| Real(it.masked_cost.map(|cost| cost.cycles), 0)),
    heading("whole_energy_mj", "energy", "mJ, whole", "energy of a whole frame on the accelerator")
        .number(|it| Real(it.whole_cost.map(|cost| cost.energy_mj), 4)),
    heading("energy_mj", "energy", "mJ, masked", ENERGY)
        .mean(|it| Real(it.masked_cost.map(|cost| cost.energy_mj), 4)),
    heading("limit", "limit", "", "changes up to this are not passed on")
        .number(|it| Limit(it.limit.map(f64::from))),
    heading("relative_rms", "error", "", "relative RMS difference from a whole computation")
        .mean(|it| Error(it.relative_rms)),
];

/// The columns of the table of frames. Columns that were added to the files later are at the end.
pub(crate) const FRAMES: &[FigureColumn<FrameFigures>] = &[
    heading("name", "name", "", "the frame in its input").text(|it| Text(it.name.clone())),
    file_column("t_us", |it| Count(it.time_us)),
    heading("active_share", "active", REGIONS, ACTIVE).number(|it| Share(it.active_share)),
    heading("changed_share", "changed", REGIONS, CHANGED).number(|it| Share(it.changed_share)),
    heading("needed_share", "needed", MACS, NEEDED).page_number(|it| Share(it.macs.needed_share())),
    heading("scheduled_share", "computed", MACS, COMPUTED)
        .page_number(|it| Share(it.macs.scheduled_share())),
    file_column("macs_dense", |it| real(it.macs.whole_frame)),
    file_column("macs_needed", |it| real(it.macs.needed)),
    file_column("macs_scheduled", |it| real(it.macs.scheduled)),
    file_column("read_bytes", |it| real(it.traffic.read_bytes)),
    file_column("halo_bytes", |it| real(it.traffic.halo_bytes)),
    file_column("written_bytes", |it| real(it.traffic.written_bytes)),
    heading("seconds", "time", "ms", "time of the frame on this computer")
        .number(|it| Milliseconds(it.seconds, 2)),
    heading("relative_rms", "error", "", DIFFERENCE).number(|it| Error(it.relative_rms)),
    heading("clip", "clip", "", "the clip or set of the frame").text(|it| Text(it.clip.clone())),
    file_column("counted", |it| Flag(it.is_counted)),
    file_column("whole_latency_seconds", |it| Real(it.whole_cost.map(|cost| cost.seconds), 0)),
    file_column("latency_seconds", |it| Real(it.masked_cost.map(|cost| cost.seconds), 0)),
    file_column("whole_energy_mj", |it| Real(it.whole_cost.map(|cost| cost.energy_mj), 4)),
    file_column("energy_mj", |it| Real(it.masked_cost.map(|cost| cost.energy_mj), 4)),
    heading("sent_bytes", "sent", "bytes", SENT)
        .number(|it| Real(it.whole_frame_agreement.map(|sight| sight.sent_bytes), 0)),
    heading("picture_psnr", "picture", "dB", PICTURE).number(|it| {
        it.whole_frame_agreement.map_or(Real(None, 1), |sight| Psnr(sight.picture_psnr))
    }),
    heading("agreement", "agreement", "%", FINDINGS_AGREE).number(|it| {
        it.whole_frame_agreement.map_or(Real(None, 1), |sight| Share(sight.agreement))
    }),
    heading("whole_detections", "found", "whole", "detections in the whole frame")
        .number(|it| detection_count(it, |found| found.whole)),
    heading(
        "kept_detections",
        "found",
        "kept",
        "of these, detections on the receiver's screen, too",
    )
    .number(|it| detection_count(it, |found| found.kept)),
    heading("added_detections", "found", "added", "detections on the receiver's screen alone")
        .number(|it| detection_count(it, |found| found.added)),
];

fn detection_count(frame: &FrameFigures, of: fn(&DetectionCounts) -> u64) -> FigureValue {
    let found = frame.whole_frame_agreement.and_then(|sight| sight.found);
    found.map_or(Real(None, 0), |found| Count(of(&found)))
}

pub(crate) const DETECTIONS: &[FigureColumn<DetectionRow>] = &[
    file_column("clip", |it| Text(it.clip.clone())),
    file_column("frame", |it| Count(it.frame)),
    file_column("name", |it| Text(it.name.clone())),
    file_column("whole", |it| Flag(it.is_whole)),
    file_column("both", |it| Flag(it.is_in_both)),
    file_column("class", |it| Count(it.detection.class as u64)),
    file_column("score", |it| real(it.detection.score.into())),
    file_column("x0", |it| real(it.detection.rect.x0)),
    file_column("y0", |it| real(it.detection.rect.y0)),
    file_column("x1", |it| real(it.detection.rect.x1)),
    file_column("y1", |it| real(it.detection.rect.y1)),
];

/// A trial of tuning, with the name of its kind of limits.
pub(crate) type NamedTrial = (&'static str, TuningTrial);

/// The columns of the table of tuning trials.
pub(crate) const TRIALS: &[FigureColumn<NamedTrial>] = &[
    heading("limits", "limits", "", LIMITS).text(|it| Text(it.0.to_owned())),
    heading("relative_limit", "relative limit", "", RELATIVE_LIMIT)
        .number(|it| Limit(it.1.relative_limit)),
    heading("needed_share", "needed", MACS, NEEDED).number(|it| Share(it.1.needed_share)),
    heading("agreement", "agreement", "% of frames", AGREEMENT)
        .number(|it| Share(it.1.outputs.agreement)),
    heading("cosine", "cosine", "", COSINE).number(|it| Real(Some(it.1.outputs.cosine), 6)),
    heading("psnr", "PSNR", "dB", "of all outputs; = means equal")
        .number(|it| Psnr(it.1.outputs.psnr)),
    heading("largest", "largest", "", "largest difference of an output")
        .number(|it| Error(Some(it.1.outputs.largest))),
    heading("relative_rms", "error", "relative", "relative RMS error of the outputs")
        .number(|it| Error(Some(it.1.outputs.relative_rms))),
    heading("rms_of_variation", "error", "% of variation", VARIATION)
        .number(|it| Share(it.1.outputs.rms_of_variation)),
    heading("holds", "goal", "", "whether the goal is reached").text(|it| GoalReached(it.1.holds)),
];

fn real(value: f64) -> FigureValue {
    Real(Some(value), 0)
}

/// Joins the lengths of a shape with `between`.
pub(crate) fn shape_text(lengths: &[usize], between: &str) -> String {
    lengths.iter().map(ToString::to_string).collect::<Vec<_>>().join(between)
}

impl FigureValue {
    /// Converts the value for a file.
    fn into_cell(self) -> TableCell {
        match self {
            Text(words) => TableCell::Text(words),
            Shape(lengths) => TableCell::Text(shape_text(&lengths, "x")),
            Flag(flag) | GoalReached(flag) => TableCell::Flag(flag),
            Count(count) => TableCell::Count(Some(count)),
            Share(value) | Milliseconds(value, _) => TableCell::Real(Some(value)),
            Real(value, _) | Error(value) | Limit(value) | Psnr(value) => TableCell::Real(value),
        }
    }
}

/// Creates the table of a file. With a name for it, the first column holds the number of each row.
pub(crate) fn table<'a, T: 'a>(
    number: Option<&str>,
    columns: &[FigureColumn<T>],
    rows: impl Iterator<Item = (u64, &'a T)>,
) -> Table {
    let row = |(at, row): (u64, &T)| -> NamedCells {
        let number = number.map(|name| (name.to_owned(), TableCell::Count(Some(at))));
        number.into_iter().chain(file_cells(columns, row)).collect()
    };
    Table::from_rows(rows.map(row))
}

/// Creates the table of detections, which has its columns even if the network finds nothing.
pub(crate) fn detection_table(rows: &[DetectionRow]) -> Table {
    let example = file_cells(DETECTIONS, &DetectionRow::default()).collect();
    table(None, DETECTIONS, (0..).zip(rows)).with_columns_of(example)
}

fn file_cells<T>(
    columns: &[FigureColumn<T>],
    row: &T,
) -> impl Iterator<Item = (String, TableCell)> {
    let filed = columns.iter().filter(|column| column.is_in_files);
    filed.map(|column| (column.heading.key.to_owned(), (column.value)(row).into_cell()))
}
