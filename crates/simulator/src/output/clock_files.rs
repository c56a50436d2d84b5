// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files `clocks.csv`, `clocks.parquet` and `clocks.npy`: the clocks at which a core decides regions, sends
//! their words and loses them. The timed model computes them beside the engine of the run, because
//! a lost region changes the values of the frames after it.

use std::path::{Path, PathBuf};

use foveate_design::Design;
use foveate_output::{
    npy::{ElementType, NpyWriter},
    tables::{Column, ColumnType, TableValue},
};
use foveate_timed::{ClockEvent, ClockRow, TimedClip};
use serde::Serialize;

use super::ClockOptions;
use super::csv::CsvFile;
use super::latency_files::LatencyFiles;
use super::parquet_file::ParquetFile;
use super::sink::SinkFrame;
use crate::SimulatorError;

const COLUMN_TYPES: [ColumnType; ClockRow::COLUMNS.len()] = [
    ColumnType::Text,
    ColumnType::Long,
    ColumnType::Int,
    ColumnType::Long,
    ColumnType::Long,
    ColumnType::Int,
    ColumnType::Int,
    ColumnType::Flag,
    ColumnType::Flag,
];

/// The figures of a run in clocks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ClockFigures {
    /// The last clock at which a region was decided, sent or lost.
    pub last_clock: u64,
    /// The number of words that left.
    pub words: u64,
    /// The number of regions that were lost.
    pub lost_regions: u64,
}

impl ClockFigures {
    fn add(&mut self, row: &ClockRow) {
        self.last_clock = self.last_clock.max(row.last_clock);
        self.words += u64::from(row.words);
        match row.event {
            ClockEvent::Loss => self.lost_regions += 1,
            ClockEvent::Decision | ClockEvent::Pixels | ClockEvent::Means => {}
        }
    }
}

/// The clocks of the clip and their open files.
pub(super) struct ClockFiles {
    /// The clip, until it has ended.
    clip: Option<TimedClip>,
    rows: ClockRows,
    latency: LatencyFiles,
    folder: PathBuf,
}

impl ClockFiles {
    pub(super) fn create(
        folder: &Path,
        design: &Design,
        options: &ClockOptions,
    ) -> Result<Self, SimulatorError> {
        let heading = ClockRow::COLUMNS.join(",");
        let columns = ClockRow::COLUMNS.iter().zip(COLUMN_TYPES);
        let columns: Vec<_> = columns
            .map(|(&name, kind)| Column { name: name.to_owned(), kind, optional: false })
            .collect();
        let csv = options.csv.then(|| CsvFile::create(&folder.join("clocks.csv"), &heading));
        let parquet = folder.join("clocks.parquet");
        let parquet = options.parquet.then(|| ParquetFile::create(&parquet, "clocks", &columns));
        let (csv, parquet) = (csv.transpose()?, parquet.transpose()?);
        let array = folder.join("clocks.npy");
        let row_shape = [ClockRow::COLUMNS.len()];
        let array =
            options.npy.then(|| NpyWriter::create(&array, ElementType::Signed64, &row_shape));
        let array = array.transpose()?;
        let rows = ClockRows { csv, parquet, array, figures: ClockFigures::default() };
        let latency = LatencyFiles::create(folder, design, options.clock_hz)?;
        let clip = TimedClip::new(design, options.clock_hz, &options.sink);
        Ok(Self { clip: Some(clip), rows, latency, folder: folder.to_owned() })
    }

    /// Adds the rows that are certain after a frame.
    pub(super) fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let Self { clip, rows, latency, .. } = self;
        let source = sink_frame.source;
        let pixels = source.frame.borrowed_pixels();
        let Some(clip) = clip else { return Ok(()) };
        if let Some(frame) = clip.step(pixels, source.time_us, &mut |row| rows.push(row))? {
            latency.push(&frame);
        }
        Ok(())
    }

    pub(super) fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.rows.write_out()?;
        self.latency.write_pending()
    }

    /// Adds the rows that still come after the last frame. Returns the Parquet file, which can be
    /// left out.
    pub(super) fn end(&mut self) -> Option<ParquetFile> {
        let Self { clip, rows, latency, .. } = self;
        if let Some(clip) = clip.take() {
            clip.finish(&mut |row| rows.push(row)).for_each(|frame| latency.push(&frame));
        }
        rows.parquet.take()
    }

    /// Completes the other files, and draws the charts.
    pub(super) fn finish(self) -> Result<ClockFigures, SimulatorError> {
        self.rows.csv.map_or(Ok(()), |mut csv| csv.write_all())?;
        self.rows.array.map_or(Ok(()), NpyWriter::finish)?;
        self.latency.finish(&self.folder)?;
        Ok(self.rows.figures)
    }
}

/// The open files, and the figures of the rows in them.
struct ClockRows {
    csv: Option<CsvFile>,
    parquet: Option<ParquetFile>,
    array: Option<NpyWriter>,
    figures: ClockFigures,
}

impl ClockRows {
    fn push(&mut self, row: &ClockRow) {
        self.figures.add(row);
        let numbers = row.numbers();
        let others = numbers.iter().zip(COLUMN_TYPES).skip(1);
        let event = TableValue::Text(row.event.name());
        if let Some(csv) = &mut self.csv {
            let numbers = others.clone().map(|(&number, _)| long_value(number));
            csv.line([event].into_iter().chain(numbers));
        }
        if let Some(parquet) = &mut self.parquet {
            let values = others.map(|(&number, kind)| typed_value(number, kind));
            parquet.push([event].into_iter().chain(values));
        }
        if let Some(array) = &mut self.array {
            array.push(numbers.into_iter());
        }
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.csv.as_mut().map_or(Ok(()), CsvFile::write_pending)?;
        self.parquet.as_mut().map_or(Ok(()), ParquetFile::write_out)?;
        Ok(self.array.as_mut().map_or(Ok(()), NpyWriter::write_pending)?)
    }
}

fn long_value(number: u64) -> TableValue<'static> {
    TableValue::Long(number.cast_signed())
}

fn typed_value(number: u64, kind: ColumnType) -> TableValue<'static> {
    match kind {
        ColumnType::Int => {
            TableValue::Int(i32::try_from(number).expect("regions and words have 31 bits"))
        }
        ColumnType::Flag => TableValue::Flag(number == 1),
        ColumnType::Long | ColumnType::Real | ColumnType::Text => long_value(number),
    }
}
