// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of the table of regions. [`EventTable`] defines the columns, and a [`RowWriter`] the
//! file format.

use super::EventTableOptions;
use super::csv::CsvFile;
use super::parquet_table::ParquetTable;
use super::row_writer::RowWriter;
use super::sink::{FrameSink, SinkFrame};
use crate::SimulatorError;
use foveate_camera::Camera;
use foveate_engine::{EventFrame, EventTable};
use std::path::{Path, PathBuf};

/// One file of the table while it is written.
struct EventFileSink {
    table: EventTable,
    writer: Box<dyn RowWriter>,
}

/// Returns the sinks of the files that are asked for.
pub(super) fn event_sinks(
    folder: &Path,
    camera: &Camera,
    tables: EventTableOptions,
    has_scores: bool,
) -> Result<Vec<Box<dyn FrameSink>>, SimulatorError> {
    let table = EventTable::new(camera, tables.only_active);
    let table = if has_scores { table } else { table.without_scores() };
    let mut writers: Vec<Box<dyn RowWriter>> = Vec::new();
    if tables.csv {
        writers.push(Box::new(CsvFile::create(&folder.join("events.csv"), &table.heading())?));
    }
    if tables.parquet {
        writers.push(Box::new(ParquetTable::create(&folder.join("events.parquet"), &table)?));
    }
    let file =
        |writer| -> Box<dyn FrameSink> { Box::new(EventFileSink { table: table.clone(), writer }) };
    Ok(writers.into_iter().map(file).collect())
}

impl FrameSink for EventFileSink {
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let SinkFrame { camera, number, outcome, .. } = *sink_frame;
        let frame = EventFrame { camera, number, time_us: sink_frame.source.time_us, outcome };
        self.writer.rows(&self.table, &frame);
        Ok(())
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.writer.write_out()
    }

    fn expendable_path(&self) -> Option<PathBuf> {
        self.writer.expendable()
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        self.writer.finish()
    }
}
