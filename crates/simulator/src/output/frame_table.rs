// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file `frames.csv`, with one line per frame, so that every row of the arrays has a name
//! and a time. Names are escaped, so that `numpy.genfromtxt`, pandas and `csv` read the same
//! values.

use super::csv::CsvFile;
use super::summary::SentCounts;
use crate::SimulatorError;
use foveate_camera::Camera;
use foveate_output::tables::escape_name;
use std::path::Path;

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
