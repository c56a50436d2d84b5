// SPDX-License-Identifier: MIT OR Apache-2.0
//! Points as a table: one list of columns for CSV and Parquet.

use std::io;
use std::path::Path;

use foveate_design::FeatureKind;
use foveate_fidelity::Figures;
use foveate_staging::write_file;
use foveate_tables::{Column, Kind, ParquetWriter, Value};

use crate::ExploreError;
use crate::row::{Row, real};

/// A value of the table. Numbers that are not there are empty in CSV and null in Parquet.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cell {
    Text(String),
    Count(Option<u64>),
    Real(Option<f64>),
    Flag(bool),
}

/// Columns with their values, row by row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    pub(crate) columns: Vec<String>,
    pub(crate) rows: Vec<Vec<Cell>>,
}

/// The cells of a row with their names.
type Cells = Vec<(String, Cell)>;

impl Table {
    /// A table of rows that have the same columns.
    pub(crate) fn of(rows: impl Iterator<Item = Cells>) -> Self {
        let mut table = Self::default();
        for row in rows {
            let (columns, cells) = row.into_iter().unzip();
            table.columns = columns;
            table.rows.push(cells);
        }
        table
    }

    /// CSV with a line of names.
    pub(crate) fn csv(&self) -> String {
        let row = |row: &Vec<Cell>| row.iter().map(|cell| cell.value().to_string()).collect();
        foveate_tables::csv(std::iter::once(self.columns.clone()).chain(self.rows.iter().map(row)))
    }

    /// Parquet: one group.
    pub(crate) fn write_parquet(&self, path: &Path) -> Result<(), ExploreError> {
        let bytes = self.parquet().map_err(ExploreError::io("write", path))?;
        Ok(write_file(path, &bytes)?)
    }

    fn parquet(&self) -> io::Result<Vec<u8>> {
        let cells = self.rows.first().into_iter().flatten();
        let columns = self.columns.iter().zip(cells).map(|(name, cell)| cell.column(name));
        let mut file = ParquetWriter::new(Vec::new(), "points", &columns.collect::<Vec<_>>())?;
        for row in &self.rows {
            file.push(row.iter().map(Cell::value));
        }
        file.finish()
    }
}

impl Cell {
    /// The column of cells like this one. In the names of Parquet, points are for columns inside columns.
    fn column(&self, name: &str) -> Column {
        let (kind, optional) = match self {
            Self::Text(_) => (Kind::Text, false),
            Self::Count(_) => (Kind::Long, true),
            Self::Real(_) => (Kind::Real, true),
            Self::Flag(_) => (Kind::Flag, false),
        };
        Column { name: name.replace('.', "_"), kind, optional }
    }

    fn value(&self) -> Value<'_> {
        match self {
            Self::Text(text) => Value::Text(text),
            Self::Count(Some(count)) => {
                Value::Long(i64::try_from(*count).expect("nothing is counted up to 2^63"))
            }
            Self::Real(Some(value)) => Value::Real(*value),
            Self::Flag(flag) => Value::Flag(*flag),
            Self::Count(None) | Self::Real(None) => Value::None,
        }
    }
}

/// The columns of a point.
pub(crate) fn point(row: &Row, axes: &[String]) -> Cells {
    let mut cells: Cells = vec![("point".to_owned(), count(row.number as u64))];
    let settings = axes.iter().zip(&row.settings);
    cells.extend(settings.map(|(axis, value)| (axis.clone(), Cell::Text(value.clone()))));
    cells.extend(errors(&row.figures));
    let area = row.silicon.as_ref();
    let of = |take: fn(&crate::Silicon) -> u64| Cell::Count(area.map(take));
    cells.extend(
        [
            ("bytes_per_frame", Cell::Real(Some(row.bytes_per_frame))),
            ("clocks_per_frame", count(row.clocks_per_frame)),
            ("frames_per_second", count(row.frames_per_second)),
            ("unit_lut", of(|area| area.unit.lut_total_packed)),
            ("unit_ff", of(|area| area.unit.ff)),
            ("unit_lutram", of(|area| area.unit.lut_memory_packed)),
            ("units", of(|area| area.units)),
            ("lut", of(|area| area.array.lut_total_packed)),
            ("ff", of(|area| area.array.ff)),
            ("lutram", of(|area| area.array.lut_memory_packed)),
            ("ramb36", Cell::Real(area.map(|area| real(area.array.bram18) / 2.0))),
            ("dsp", of(|area| area.array.dsp)),
            ("logic_levels", of(|area| area.levels.into())),
            ("simulated_per_second", Cell::Real(Some(row.simulated_per_second))),
            ("front_speed", Cell::Flag(row.front.speed)),
            ("front_area", Cell::Flag(row.front.area)),
            ("front", Cell::Flag(row.front.all)),
            ("fingerprint", Cell::Text(row.fingerprint.clone())),
        ]
        .map(|(name, cell)| (name.to_owned(), cell)),
    );
    cells
}

/// The columns that say what a row of one clip is about.
pub(crate) fn names(point: usize, clip: &str) -> Cells {
    vec![
        ("point".to_owned(), count(point as u64)),
        ("clip".to_owned(), Cell::Text(clip.to_owned())),
    ]
}

/// The columns of errors.
pub(crate) fn errors(figures: &Figures) -> Cells {
    let real = |value: f64| Cell::Real(Some(value));
    let mut cells: Cells = [
        ("frames", count(figures.frames)),
        ("active", real(figures.active)),
        ("ideal_active", real(figures.ideal_active)),
        ("srs_flips", real(figures.srs_flips)),
        ("trs_flips", real(figures.trs_flips)),
        ("action_flips", real(figures.action_flips)),
        ("missed", real(figures.missed)),
        ("false_alarms", real(figures.false_alarms)),
        ("active_iou", real(figures.active_iou)),
        ("psnr_ideal", Cell::Real(figures.psnr_ideal)),
        ("ssim_ideal", real(figures.ssim_ideal)),
        ("psnr_input", Cell::Real(figures.psnr_input)),
        ("ssim_input", real(figures.ssim_input)),
        ("stale_max", real(figures.staleness.max)),
        ("stale_mean", real(figures.staleness.mean)),
        ("stale_share", real(figures.staleness.share)),
        ("stale_frames", count(figures.staleness.longest)),
    ]
    .map(|(name, cell)| (name.to_owned(), cell))
    .into();
    for feature in score_names() {
        let score = figures.scores.iter().find(|score| score.feature == feature);
        let of = |take: fn(&foveate_fidelity::ScoreError) -> f64| Cell::Real(score.map(take));
        cells.push((format!("{feature}_max"), of(|score| score.max)));
        cells.push((format!("{feature}_mean"), of(|score| score.mean)));
        cells.push((format!("{feature}_rms"), of(|score| score.rms)));
    }
    cells
}

/// Every score that can be compared; the same columns for all spaces, so that tables can be joined.
fn score_names() -> impl Iterator<Item = &'static str> {
    FeatureKind::ALL.iter().map(|kind| kind.name()).chain(["temporal"])
}

fn count(value: u64) -> Cell {
    Cell::Count(Some(value))
}
