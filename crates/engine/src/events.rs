// SPDX-License-Identifier: MIT OR Apache-2.0
//! The table of regions: the events of a region camera as data, one row per region and frame.
//!
//! This module alone defines the columns and the text of a row.

use std::fmt;
use std::io::Write as _;

use foveate_camera::{Camera, RegionAction};

use crate::FrameOutcome;

/// A column of the table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EventColumn {
    /// The name of the column.
    pub name: String,
    /// The type of the column's values.
    pub value_type: EventColumnType,
}

/// The type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventColumnType {
    /// A signed integer of 64 bits.
    Long,
    /// A signed integer of 32 bits.
    Int,
    /// A truth value.
    Flag,
    /// A text.
    Text,
}

/// A value of a row. In text, a flag is 0 or 1, so that tools that read only numbers can read every
/// column but the action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventValue {
    /// A value of a column of type [`EventColumnType::Long`].
    Long(i64),
    /// A value of a column of type [`EventColumnType::Int`].
    Int(i32),
    /// A value of a column of type [`EventColumnType::Flag`].
    Flag(bool),
    /// A value of a column of type [`EventColumnType::Text`].
    Text(&'static str),
}

impl fmt::Display for EventValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Long(value) => value.fmt(f),
            Self::Int(value) => value.fmt(f),
            Self::Flag(value) => u8::from(*value).fmt(f),
            Self::Text(value) => f.write_str(value),
        }
    }
}

/// The property of a region that a column shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum EventField {
    Frame,
    Time,
    Column,
    Row,
    Left,
    Top,
    Srs,
    Trs,
    /// The score of the feature with this number.
    Score(usize),
    TemporalCount,
    /// The columns to the right by which the content of the region moved.
    DisplacementRight,
    /// The rows down by which the content of the region moved.
    DisplacementDown,
    Action,
}

impl EventField {
    fn kind(self) -> EventColumnType {
        match self {
            Self::Frame | Self::Time | Self::Score(_) => EventColumnType::Long,
            Self::Column
            | Self::Row
            | Self::Left
            | Self::Top
            | Self::TemporalCount
            | Self::DisplacementRight
            | Self::DisplacementDown => EventColumnType::Int,
            Self::Srs | Self::Trs => EventColumnType::Flag,
            Self::Action => EventColumnType::Text,
        }
    }

    fn value_of(self, frame: &EventFrame<'_>, region: usize) -> EventValue {
        let EventFrame { camera, number, time_us, outcome } = *frame;
        let (columns, side) = (camera.columns() as usize, camera.region_size() as usize);
        let (column, row) = (region % columns, region / columns);
        match self {
            Self::Frame => long_value(number),
            // A damaged clip may claim any time. All times beyond 292,000 years become the same
            // value.
            Self::Time => EventValue::Long(time_us.try_into().unwrap_or(i64::MAX)),
            Self::Column => int_value(column),
            Self::Row => int_value(row),
            Self::Left => int_value(column * side),
            Self::Top => int_value(row * side),
            Self::Srs => EventValue::Flag(outcome.srs[region]),
            Self::Trs => EventValue::Flag(outcome.trs[region]),
            Self::Score(feature) => long_value(outcome.scores[feature][region]),
            Self::TemporalCount => int_value(outcome.temporal_count[region] as usize),
            Self::DisplacementRight => EventValue::Int(outcome.displacements[region].dx.into()),
            Self::DisplacementDown => EventValue::Int(outcome.displacements[region].dy.into()),
            Self::Action => EventValue::Text(outcome.actions[region].name()),
        }
    }
}

fn long_value(value: u64) -> EventValue {
    EventValue::Long(value.try_into().expect("scores are below 2^54, and frames are counted"))
}

fn int_value(value: usize) -> EventValue {
    EventValue::Int(value.try_into().expect("coordinates are below 2^15 and counts below 2^13"))
}

/// Returns the columns of a camera's table, in order.
fn columns(camera: &Camera) -> Vec<(EventColumn, EventField)> {
    let scores = camera.features().iter().enumerate();
    let scores =
        scores.map(|(at, feature)| (format!("score_{}", feature.kind()), EventField::Score(at)));
    let named_field = |(name, field): (&str, EventField)| (name.to_owned(), field);
    let before = [
        ("frame", EventField::Frame),
        ("t_us", EventField::Time),
        ("x", EventField::Column),
        ("y", EventField::Row),
        ("x0", EventField::Left),
        ("y0", EventField::Top),
        ("srs", EventField::Srs),
        ("trs", EventField::Trs),
    ];
    let flow = camera.displacement_feature().map_or(&[][..], |_| {
        &[("dx", EventField::DisplacementRight), ("dy", EventField::DisplacementDown)]
    });
    let after =
        [&[("t_count", EventField::TemporalCount)], flow, &[("action", EventField::Action)]];
    let after = after.concat().into_iter().map(named_field);
    let all = before.map(named_field).into_iter().chain(scores).chain(after);
    all.map(|(name, field)| (EventColumn { name, value_type: field.kind() }, field)).collect()
}

/// One frame of a run and its outcome.
#[derive(Clone, Copy, Debug)]
pub struct EventFrame<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// The number of the frame in the run.
    pub number: u64,
    /// The time since the first frame in microseconds.
    pub time_us: u64,
    /// The outcome of the frame.
    pub outcome: &'a FrameOutcome,
}

/// The table of regions of a camera.
#[derive(Clone, Debug)]
pub struct EventTable {
    columns: Vec<EventColumn>,
    fields: Vec<EventField>,
    only_active: bool,
}

impl EventTable {
    /// Makes the table with a row per region and frame. If `only_active` is set, it has rows only
    /// for regions that send pixels or a summary.
    #[must_use]
    pub fn new(camera: &Camera, only_active: bool) -> Self {
        let (columns, fields) = columns(camera).into_iter().unzip();
        Self { columns, fields, only_active }
    }

    /// Returns the table without the columns that need scores: the scores and the temporal count.
    #[must_use]
    pub fn without_scores(self) -> Self {
        let pairs = self.columns.into_iter().zip(self.fields);
        let remaining = pairs.filter(|(_, field)| {
            !matches!(field, EventField::Score(_) | EventField::TemporalCount)
        });
        let (columns, fields) = remaining.unzip();
        Self { columns, fields, ..self }
    }

    /// Returns the columns in order.
    #[must_use]
    pub fn columns(&self) -> &[EventColumn] {
        &self.columns
    }

    /// Returns the first line of the table as CSV, without its line end.
    #[must_use]
    pub fn heading(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|column| column.name.as_str()).collect();
        names.join(",")
    }

    /// Appends the rows of a frame of this camera as lines of CSV.
    pub fn csv(&self, frame: &EventFrame<'_>, text: &mut Vec<u8>) {
        self.rows(frame, |values| {
            for (index, value) in values.enumerate() {
                let comma = if index == 0 { "" } else { "," };
                // A write into memory cannot fail.
                let _ = write!(text, "{comma}{value}");
            }
            text.push(b'\n');
        });
    }

    /// Calls `row` for each row of a frame of this camera, in the order of the regions, with one
    /// value per column.
    pub fn rows(
        &self,
        frame: &EventFrame<'_>,
        mut row: impl FnMut(&mut dyn Iterator<Item = EventValue>),
    ) {
        for (region, &action) in frame.outcome.actions.iter().enumerate() {
            let is_event = match action {
                RegionAction::Forward | RegionAction::Summarize => true,
                RegionAction::Hold | RegionAction::Blank => false,
            };
            if is_event || !self.only_active {
                row(&mut self.fields.iter().map(|field| field.value_of(frame, region)));
            }
        }
    }
}
