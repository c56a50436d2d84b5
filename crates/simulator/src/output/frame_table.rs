// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file `frames.csv`, with one line per frame, so that every row of the arrays has a name
//! and a time. Names are escaped, so that `numpy.genfromtxt`, pandas and `csv` read the same
//! values. The interface of the file formats of the table of regions.
//!
//! A file, plain or gzipped, with a header that is known only at the end, such as a count.
//!
//! In a gzipped file the header is a stored block of its own before the compressed data, so that it
//! can be written in place at the end. The checksum is combined from both parts. The bytes contain
//! no time and no name.
//!
//! The table of regions as a Parquet file.

use super::csv::CsvFile;
use super::npz::{DeflatePacker, STORED_BLOCK_HEADER_BYTES, stored_block};
use super::parquet_file::ParquetFile;
use super::summary::SentCounts;
use crate::SimulatorError;
use flate2::Compression;
use foveate_camera::Camera;
use foveate_engine::{EventColumn, EventColumnType, EventFrame, EventTable, EventValue};
use foveate_output::tables::{Column, ColumnType, TableValue, escape_name};
use foveate_tools::GrowingFile;
use std::path::{Path, PathBuf};

pub(super) struct FrameRow<'a> {
    pub(super) frame: u64,
    pub(super) time_us: u64,
    pub(super) name: &'a str,
    pub(super) label: Option<&'a str>,
    pub(super) srs: u64,
    pub(super) trs: u64,
    pub(super) active: u64,
    pub(super) sent: SentCounts,
    /// The version of the map of classes, in a table with such a column.
    pub(super) map_version: Option<u16>,
}

/// The open file.
pub(super) struct FrameTable {
    csv: CsvFile,
    /// True if irrelevant regions send summaries, so that the table has a column for them.
    has_summaries: bool,
    /// True if the table has a column for the versions of the maps of classes.
    has_map_versions: bool,
}

impl FrameTable {
    pub(super) fn create(
        path: &Path,
        camera: &Camera,
        has_map_versions: bool,
    ) -> Result<Self, SimulatorError> {
        let has_summaries = camera.periphery().is_some();
        let heading =
            "frame,t_us,name,label,srs_regions,trs_regions,active_regions,pixels_forwarded";
        let summaries = if has_summaries { ",summaries_sent" } else { "" };
        let maps = if has_map_versions { ",map_version" } else { "" };
        let csv = CsvFile::create(path, &format!("{heading}{summaries}{maps}"))?;
        Ok(Self { csv, has_summaries, has_map_versions })
    }

    pub(super) fn push(&mut self, row: &FrameRow<'_>) {
        let FrameRow { frame, time_us, name, label, srs, trs, active, sent, map_version } = row;
        let (name, label) = (escape_name(name), escape_name(label.unwrap_or_default()));
        let mut counts = format!("{srs},{trs},{active},{}", sent.pixels);
        if self.has_summaries {
            counts = format!("{counts},{}", sent.summaries);
        }
        if self.has_map_versions {
            counts = format!("{counts},{}", map_version.unwrap_or_default());
        }
        self.csv.line([format!("{frame},{time_us},{name},{label},{counts}")]);
    }

    pub(super) fn write_pending(&mut self) -> Result<(), SimulatorError> {
        self.csv.write_pending()
    }

    pub(super) fn finish(mut self) -> Result<(), SimulatorError> {
        self.csv.write_all()
    }
}

/// An open file of the table.
pub(super) trait RowWriter: Send {
    /// Appends the rows of a frame.
    fn rows(&mut self, table: &EventTable, frame: &EventFrame<'_>);
    /// Writes the buffered data, as [`super::sink::FrameSink::write_out`] does.
    fn write_out(&mut self) -> Result<(), SimulatorError>;
    /// Returns the path that can be given up, as [`super::sink::FrameSink::expendable_path`] does.
    fn expendable(&self) -> Option<PathBuf> {
        None
    }
    fn finish(self: Box<Self>) -> Result<(), SimulatorError>;
}

impl RowWriter for CsvFile {
    fn rows(&mut self, table: &EventTable, frame: &EventFrame<'_>) {
        table.csv(frame, self.buffer());
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.write_pending()
    }

    fn finish(mut self: Box<Self>) -> Result<(), SimulatorError> {
        self.write_all()
    }
}

/// The gzip header: magic number, deflate, no flags, no time, no level, no system.
const GZIP_HEADER: [u8; 10] = [0x1F, 0x8B, 8, 0, 0, 0, 0, 0, 0, 0xFF];

/// The open file, with `HEADER` bytes reserved at its start.
pub(super) struct HeadedFile<const HEADER: usize> {
    file: GrowingFile,
    packer: Option<DeflatePacker>,
}

impl<const HEADER: usize> HeadedFile<HEADER> {
    /// Creates a file that does not exist yet.
    pub(super) fn create(path: &Path, packed: bool) -> Result<Self, SimulatorError> {
        let mut file = GrowingFile::create_new(path)?;
        if packed {
            file.append(&GZIP_HEADER);
            file.append(&stored_block(&[0; HEADER]));
        } else {
            file.append(&[0; HEADER]);
        }
        Ok(Self { file, packer: packed.then(|| DeflatePacker::new(Compression::default())) })
    }

    pub(super) fn write(&mut self, bytes: &[u8]) {
        match &mut self.packer {
            None => self.file.append(bytes),
            Some(packer) => packer.write(bytes, self.file.pending_mut()),
        }
    }

    pub(super) fn write_out(&mut self) -> Result<(), SimulatorError> {
        Ok(self.file.write_pending()?)
    }

    /// Completes the file with its header.
    pub(super) fn finish(mut self, header: &[u8; HEADER]) -> Result<(), SimulatorError> {
        let Some(packer) = self.packer else {
            return Ok(self.file.overwrite(0, header)?);
        };
        let (last, checksum, length) = packer.finish(header);
        self.file.append(&last);
        self.file.append(&checksum.to_le_bytes());
        self.file.append(&low_32_bits(length).to_le_bytes());
        Ok(self.file.overwrite((GZIP_HEADER.len() + STORED_BLOCK_HEADER_BYTES) as u64, header)?)
    }
}

/// Returns a length modulo 2^32, as gzip stores it.
fn low_32_bits(length: u64) -> u32 {
    let [a, b, c, d, ..] = length.to_le_bytes();
    u32::from_le_bytes([a, b, c, d])
}

/// The open file.
pub(super) struct ParquetTable(ParquetFile);

impl ParquetTable {
    pub(super) fn create(path: &Path, table: &EventTable) -> Result<Self, SimulatorError> {
        let columns: Vec<Column> = table.columns().iter().map(parquet_column).collect();
        Ok(Self(ParquetFile::create(path, "events", &columns)?))
    }
}

impl RowWriter for ParquetTable {
    fn rows(&mut self, table: &EventTable, frame: &EventFrame<'_>) {
        table.rows(frame, |values| self.0.push(values.map(parquet_value)));
    }

    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.0.write_out()
    }

    fn expendable(&self) -> Option<PathBuf> {
        Some(self.0.path())
    }

    fn finish(self: Box<Self>) -> Result<(), SimulatorError> {
        self.0.finish()
    }
}

fn parquet_column(EventColumn { name, value_type: kind }: &EventColumn) -> Column {
    let kind = match kind {
        EventColumnType::Long => ColumnType::Long,
        EventColumnType::Int => ColumnType::Int,
        EventColumnType::Flag => ColumnType::Flag,
        EventColumnType::Text => ColumnType::Text,
    };
    Column { name: name.clone(), kind, optional: false }
}

fn parquet_value(value: EventValue) -> TableValue<'static> {
    match value {
        EventValue::Long(value) => TableValue::Long(value),
        EventValue::Int(value) => TableValue::Int(value),
        EventValue::Flag(value) => TableValue::Flag(value),
        EventValue::Text(value) => TableValue::Text(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    #[test]
    fn the_header_comes_last_and_gzip_reads_it() {
        let dir = tempfile::tempdir().unwrap();
        for (name, packed) in [("plain", false), ("packed", true)] {
            let path = dir.path().join(name);
            let mut file = HeadedFile::<4>::create(&path, packed).unwrap();
            let body: Vec<u8> = (0..7).cycle().take(200_000).collect();
            body.chunks(999).for_each(|chunk| file.write(chunk));
            file.finish(b"head").unwrap();
            let bytes = std::fs::read(&path).unwrap();
            let mut unpacked = Vec::new();
            if packed {
                assert!(bytes.len() < 10_000);
                // The file has one gzip member, with checksum and length.
                flate2::read::GzDecoder::new(&bytes[..]).read_to_end(&mut unpacked).unwrap();
            } else {
                unpacked = bytes;
            }
            assert_eq!(unpacked, [&b"head"[..], &body].concat());
            assert!(HeadedFile::<4>::create(&path, packed).is_err(), "nothing is written over");
        }
    }
}
