// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of regions: one row per region and frame, the region camera's events as data.
//!
//! What the columns are is said once, here; how they are written is the business of a [`RowWriter`].

use std::path::{Path, PathBuf};

use foveate_camera::{Action, Camera};
use foveate_engine::FrameOutcome;
use foveate_files::tables::{Column, Kind, Value};

use super::EventTables;
use super::csv::Csv;
use super::parquet::ParquetTable;
use super::row_writer::RowWriter;
use super::sink::{Sink, Step};
use crate::SimulatorError;

/// What a column says of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Field {
    Frame,
    Time,
    Column,
    Row,
    Left,
    Top,
    Srs,
    Trs,
    /// By number of the feature.
    Score(usize),
    Count,
    Action,
}

impl Field {
    fn kind(self) -> Kind {
        match self {
            Self::Frame | Self::Time | Self::Score(_) => Kind::Long,
            Self::Column | Self::Row | Self::Left | Self::Top | Self::Count => Kind::Int,
            Self::Srs | Self::Trs => Kind::Flag,
            Self::Action => Kind::Text,
        }
    }

    fn of(self, moment: &Moment<'_>, region: usize) -> Value<'static> {
        let Moment { camera, number, time_us, outcome } = *moment;
        let (columns, side) = (camera.columns() as usize, camera.region_size() as usize);
        let (column, row) = (region % columns, region / columns);
        match self {
            Self::Frame => long(number),
            // A damaged clip may claim any time; beyond 292,000 years all are the same.
            Self::Time => Value::Long(time_us.try_into().unwrap_or(i64::MAX)),
            Self::Column => int(column),
            Self::Row => int(row),
            Self::Left => int(column * side),
            Self::Top => int(row * side),
            Self::Srs => Value::Flag(outcome.srs[region]),
            Self::Trs => Value::Flag(outcome.trs[region]),
            Self::Score(feature) => long(outcome.scores[feature][region]),
            Self::Count => int(outcome.temporal_count[region] as usize),
            Self::Action => Value::Text(outcome.actions[region].name()),
        }
    }
}

fn long(value: u64) -> Value<'static> {
    Value::Long(value.try_into().expect("scores are below 2^54, and frames are counted"))
}

fn int(value: usize) -> Value<'static> {
    Value::Int(value.try_into().expect("coordinates are below 2^15 and counts below 2^13"))
}

/// The columns of a camera's table, in order.
fn columns(camera: &Camera) -> Vec<(Column, Field)> {
    let scores = camera.features().iter().enumerate();
    let scores =
        scores.map(|(at, feature)| (format!("score_{}", feature.kind()), Field::Score(at)));
    let named = |(name, field): (&str, Field)| (name.to_owned(), field);
    let before = [
        ("frame", Field::Frame),
        ("t_us", Field::Time),
        ("x", Field::Column),
        ("y", Field::Row),
        ("x0", Field::Left),
        ("y0", Field::Top),
        ("srs", Field::Srs),
        ("trs", Field::Trs),
    ];
    let after = [("t_count", Field::Count), ("action", Field::Action)];
    let all = before.map(named).into_iter().chain(scores).chain(after.map(named));
    all.map(|(name, field)| (Column { name, kind: field.kind(), optional: false }, field)).collect()
}

/// One frame of a run, with what came of it.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Number of the frame in the run.
    pub number: u64,
    /// Time since the first frame in microseconds.
    pub time_us: u64,
    /// What came of it.
    pub outcome: &'a FrameOutcome,
}

/// The table of regions of a camera.
#[derive(Clone, Debug)]
pub struct EventTable {
    columns: Vec<Column>,
    fields: Vec<Field>,
    only_active: bool,
}

impl EventTable {
    /// The table with a row per region and frame, or only with those of regions that send something.
    #[must_use]
    pub fn new(camera: &Camera, only_active: bool) -> Self {
        let (columns, fields) = columns(camera).into_iter().unzip();
        Self { columns, fields, only_active }
    }

    /// The same without what only scores say.
    fn without_scores(self) -> Self {
        let pairs = self.columns.into_iter().zip(self.fields);
        let known = pairs.filter(|(_, field)| !matches!(field, Field::Score(_) | Field::Count));
        let (columns, fields) = known.unzip();
        Self { columns, fields, ..self }
    }

    /// The columns, in order.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Gives the rows of a frame of this camera, region by region, a value for each column.
    pub fn rows(
        &self,
        moment: &Moment<'_>,
        mut row: impl FnMut(&mut dyn Iterator<Item = Value<'static>>),
    ) {
        for (region, &action) in moment.outcome.actions.iter().enumerate() {
            let is_event = match action {
                Action::Forward | Action::Summarize => true,
                Action::Hold | Action::Blank => false,
            };
            if is_event || !self.only_active {
                row(&mut self.fields.iter().map(|field| field.of(moment, region)));
            }
        }
    }
}

/// One file of the table, open.
struct EventFile {
    table: EventTable,
    writer: Box<dyn RowWriter>,
}

/// The files that are wanted.
pub(super) fn sinks(
    folder: &Path,
    camera: &Camera,
    tables: EventTables,
    has_scores: bool,
) -> Result<Vec<Box<dyn Sink>>, SimulatorError> {
    let table = EventTable::new(camera, tables.only_active);
    let table = if has_scores { table } else { table.without_scores() };
    let columns = table.columns();
    let mut writers: Vec<Box<dyn RowWriter>> = Vec::new();
    if tables.csv {
        let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        writers.push(Box::new(Csv::create(&folder.join("events.csv"), &names.join(","))?));
    }
    if tables.parquet {
        writers.push(Box::new(ParquetTable::create(&folder.join("events.parquet"), columns)?));
    }
    let file = |writer| -> Box<dyn Sink> { Box::new(EventFile { table: table.clone(), writer }) };
    Ok(writers.into_iter().map(file).collect())
}

impl Sink for EventFile {
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError> {
        let Step { camera, number, outcome, .. } = *step;
        let moment = Moment { camera, number, time_us: step.source.time_us, outcome };
        let Self { table, writer } = self;
        table.rows(&moment, |values| writer.row(values));
        Ok(())
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.writer.write_out(all)
    }

    fn expendable(&self) -> Option<PathBuf> {
        self.writer.expendable()
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        self.writer.finish()
    }
}
