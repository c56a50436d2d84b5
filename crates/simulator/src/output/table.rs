// SPDX-License-Identifier: MIT OR Apache-2.0
//! `frames.csv`: one line per frame, so that every row of the arrays has a name and a time. Names are
//! plain, so that `numpy.genfromtxt`, pandas and `csv` read the same.

use std::path::Path;

use foveate_files::tables::plain;

use super::csv::Csv;
use crate::SimulatorError;

/// What the table says of a frame.
pub(super) struct FrameRow<'a> {
    pub(super) frame: u64,
    pub(super) time_us: u64,
    pub(super) name: &'a str,
    pub(super) label: Option<&'a str>,
    pub(super) srs: u64,
    pub(super) trs: u64,
    pub(super) active: u64,
    pub(super) pixels_forwarded: u64,
}

/// The file, open.
pub(super) struct FrameTable(Csv);

impl FrameTable {
    pub(super) fn create(path: &Path) -> Result<Self, SimulatorError> {
        let heading =
            "frame,t_us,name,label,srs_regions,trs_regions,active_regions,pixels_forwarded";
        Csv::create(path, heading).map(Self)
    }

    pub(super) fn push(&mut self, row: &FrameRow<'_>) {
        let FrameRow { frame, time_us, name, label, srs, trs, active, pixels_forwarded } = row;
        let (name, label) = (plain(name), plain(label.unwrap_or_default()));
        let counts = format!("{srs},{trs},{active},{pixels_forwarded}");
        self.0.line([format!("{frame},{time_us},{name},{label},{counts}")]);
    }

    pub(super) fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.0.write_out(all)
    }
}
