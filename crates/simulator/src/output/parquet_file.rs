// SPDX-License-Identifier: MIT OR Apache-2.0
//! A growing Parquet file, written in groups of rows.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use foveate_output::tables::{Column, ParquetWriter, TableValue};

use super::cannot_write;
use crate::SimulatorError;

/// The number of rows of a group: a few megabytes of memory, and few groups in the file's index.
const GROUP_ROWS: usize = 1 << 18;

/// The open file.
pub(super) struct ParquetFile {
    path: PathBuf,
    writer: ParquetWriter<File>,
    /// True if a group could not be written, so that the file cannot be completed.
    is_broken: bool,
}

impl ParquetFile {
    pub(super) fn create(
        path: &Path,
        message: &str,
        columns: &[Column],
    ) -> Result<Self, SimulatorError> {
        let file = File::create(path).map_err(cannot_write(path))?;
        let writer = ParquetWriter::new(file, message, columns).map_err(cannot_write(path))?;
        Ok(Self { path: path.to_owned(), writer, is_broken: false })
    }

    /// Adds a row with a value for each column.
    pub(super) fn push<'a>(&mut self, values: impl IntoIterator<Item = TableValue<'a>>) {
        self.writer.push(values);
    }

    /// Writes the rows of a group if there are that many.
    pub(super) fn write_out(&mut self) -> Result<(), SimulatorError> {
        if self.writer.pending_rows() < GROUP_ROWS {
            return Ok(());
        }
        let written = self.writer.write_group();
        self.is_broken = written.is_err();
        written.map_err(cannot_write(&self.path))
    }

    pub(super) fn path(&self) -> PathBuf {
        self.path.clone()
    }

    /// Completes the file.
    pub(super) fn finish(self) -> Result<(), SimulatorError> {
        let finished = match self.is_broken {
            true => Err(io::ErrorKind::StorageFull.into()),
            false => self.writer.finish().map(drop),
        };
        finished.map_err(cannot_write(&self.path))
    }
}
