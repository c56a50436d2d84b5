// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of regions: one row per region and frame, the region camera's events as data.
//!
//! What the columns are is said once, here; how they are written is the business of a [`RowWriter`].

use std::path::{Path, PathBuf};

use foveate_design::Design;
use foveate_tables::{Column, Kind, Value};

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

    fn of(self, step: &Step<'_>, region: usize) -> Value<'static> {
        let (columns, side) = (step.design.columns() as usize, step.design.region_size() as usize);
        let (column, row) = (region % columns, region / columns);
        let outcome = step.outcome;
        match self {
            Self::Frame => long(step.number),
            // A damaged clip may claim any time; beyond 292,000 years all are the same.
            Self::Time => Value::Long(step.source.time_us.try_into().unwrap_or(i64::MAX)),
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

/// The columns of a design's table, in order.
fn columns(design: &Design) -> Vec<(Column, Field)> {
    let scores = design.features().iter().enumerate();
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
    let (columns, fields): (Vec<Column>, Vec<Field>) = columns(design).into_iter().unzip();
    let mut writers: Vec<Box<dyn RowWriter>> = Vec::new();
    if tables.csv {
        let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
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
