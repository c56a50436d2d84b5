// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of regions: one row per region and frame, the region camera's events as data.
//!
//! What the columns are is said once, here; how they are written is the business of a [`RowWriter`].

use std::fmt;
use std::path::{Path, PathBuf};

use foveate_design::Design;

use super::EventTables;
use super::csv::Csv;
use super::parquet::ParquetTable;
use super::sink::{Sink, Step};
use crate::SimulatorError;

/// What a column says of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Field {
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

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Long,
    Int,
    Flag,
    Text,
}

/// A field of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Value {
    Long(i64),
    Int(i32),
    Flag(bool),
    Text(&'static str),
}

impl Field {
    pub(super) fn kind(self) -> Kind {
        match self {
            Self::Frame | Self::Time | Self::Score(_) => Kind::Long,
            Self::Column | Self::Row | Self::Left | Self::Top | Self::Count => Kind::Int,
            Self::Srs | Self::Trs => Kind::Flag,
            Self::Action => Kind::Text,
        }
    }

    fn of(self, step: &Step<'_>, region: usize) -> Value {
        let (columns, side) = (step.design.columns() as usize, step.design.region_size() as usize);
        let (column, row) = (region % columns, region / columns);
        let outcome = step.outcome;
        match self {
            Self::Frame => long(step.number),
            Self::Time => long(step.source.time_us),
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

/// Scores stay below `2^54` and times below `2^63`.
fn long(value: u64) -> Value {
    Value::Long(i64::try_from(value).unwrap_or(i64::MAX))
}

/// Coordinates stay below `2^15` and counts below `2^13`.
fn int(value: usize) -> Value {
    Value::Int(i32::try_from(value).unwrap_or(i32::MAX))
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Long(value) => value.fmt(f),
            Self::Int(value) => value.fmt(f),
            Self::Flag(value) => u8::from(*value).fmt(f),
            Self::Text(value) => f.write_str(value),
        }
    }
}

/// The columns of a design's table, in order.
pub(super) fn columns(design: &Design) -> Vec<(String, Field)> {
    let named = |name: &str, field| (name.to_owned(), field);
    let mut columns = vec![
        named("frame", Field::Frame),
        named("t_us", Field::Time),
        named("x", Field::Column),
        named("y", Field::Row),
        named("x0", Field::Left),
        named("y0", Field::Top),
        named("srs", Field::Srs),
        named("trs", Field::Trs),
    ];
    for (index, feature) in design.features().iter().enumerate() {
        columns.push((format!("score_{}", feature.kind()), Field::Score(index)));
    }
    columns.push(named("t_count", Field::Count));
    columns.push(named("action", Field::Action));
    columns
}

/// A file format of the table.
pub(super) trait RowWriter: Send {
    fn row(&mut self, values: &mut dyn Iterator<Item = Value>);
    /// As [`Sink::write_out`].
    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError>;
    /// As [`Sink::expendable`].
    fn expendable(&self) -> Option<PathBuf> {
        None
    }
    fn finish(self: Box<Self>) -> Result<(), SimulatorError>;
}

impl RowWriter for Csv {
    fn row(&mut self, values: &mut dyn Iterator<Item = Value>) {
        self.line(values);
    }

    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        Csv::write_out(self, all)
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        Csv::write_out(&mut self, true)
    }
}

/// One file of the table, open.
struct EventTable {
    fields: Vec<Field>,
    only_active: bool,
    writer: Box<dyn RowWriter>,
}

/// The files that are wanted.
pub(super) fn sinks(
    folder: &Path,
    design: &Design,
    tables: EventTables,
) -> Result<Vec<Box<dyn Sink>>, SimulatorError> {
    let columns = columns(design);
    let fields: Vec<Field> = columns.iter().map(|(_, field)| *field).collect();
    let mut writers: Vec<Box<dyn RowWriter>> = Vec::new();
    if tables.csv {
        let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
        writers.push(Box::new(Csv::create(&folder.join("events.csv"), &names.join(","))?));
    }
    if tables.parquet {
        writers.push(Box::new(ParquetTable::create(&folder.join("events.parquet"), &columns)?));
    }
    let table = |writer| -> Box<dyn Sink> {
        Box::new(EventTable { fields: fields.clone(), only_active: tables.only_active, writer })
    };
    Ok(writers.into_iter().map(table).collect())
}

impl Sink for EventTable {
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError> {
        for (region, &active) in step.outcome.active.iter().enumerate() {
            if active || !self.only_active {
                self.writer.row(&mut self.fields.iter().map(|field| field.of(step, region)));
            }
        }
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
