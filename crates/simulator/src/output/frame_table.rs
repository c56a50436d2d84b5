// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file `frames.csv`, with one line per frame, so that every row of the arrays has a name and a
//! time. Names are escaped, so that `numpy.genfromtxt`, pandas and `csv` read the same values.

use std::path::Path;

use foveate_camera::Camera;
use foveate_files::tables::escape_name;

use super::csv::CsvFile;
use super::summary::SentCounts;
use crate::SimulatorError;

/// A row of the table.
pub(super) struct FrameRow<'a> {
    pub(super) frame: u64,
    pub(super) time_us: u64,
    pub(super) name: &'a str,
    pub(super) label: Option<&'a str>,
    pub(super) srs: u64,
    pub(super) trs: u64,
    pub(super) active: u64,
    pub(super) sent: SentCounts,
}

/// The open file.
pub(super) struct FrameTable {
    csv: CsvFile,
    /// True if irrelevant regions send summaries, so that the table has a column for them.
    has_summaries: bool,
}

impl FrameTable {
    pub(super) fn create(path: &Path, camera: &Camera) -> Result<Self, SimulatorError> {
        let has_summaries = camera.periphery().is_some();
        let heading =
            "frame,t_us,name,label,srs_regions,trs_regions,active_regions,pixels_forwarded";
        let more = if has_summaries { ",summaries_sent" } else { "" };
        Ok(Self { csv: CsvFile::create(path, &format!("{heading}{more}"))?, has_summaries })
    }

    pub(super) fn push(&mut self, row: &FrameRow<'_>) {
        let FrameRow { frame, time_us, name, label, srs, trs, active, sent } = row;
        let (name, label) = (escape_name(name), escape_name(label.unwrap_or_default()));
        let mut counts = format!("{srs},{trs},{active},{}", sent.pixels);
        if self.has_summaries {
            counts = format!("{counts},{}", sent.summaries);
        }
        self.csv.line([format!("{frame},{time_us},{name},{label},{counts}")]);
    }

    pub(super) fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.csv.write_out(all)
    }
}
