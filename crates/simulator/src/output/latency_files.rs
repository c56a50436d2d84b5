// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file `latency.csv`, with the latency of every frame, and charts of it.

use std::path::Path;

use foveate_design::Design;
use foveate_timed::FrameTraffic;

use super::csv::CsvFile;
use super::latency_chart::LatencyCharts;
use crate::SimulatorError;

const COLUMNS: &str = "frame,clock,decision_clocks,word_clocks,waiting_regions,lost_regions";
/// The largest number of bytes of a row.
const ROW_BYTES: u64 = 6 * 21;
/// The largest number of frames whose rows come with that of another.
const PENDING_FRAMES: u64 = 3;

/// The open table, and the charts so far.
pub(super) struct LatencyFiles {
    csv: CsvFile,
    charts: LatencyCharts,
}

impl LatencyFiles {
    /// The largest number of bytes that may have to be written after the disk is full, with charts
    /// of less than 100 kB each.
    pub(super) const MAX_BYTES_OWED: u64 = PENDING_FRAMES * ROW_BYTES + 4 * 100_000;

    pub(super) fn create(
        folder: &Path,
        design: &Design,
        clock_hz: Option<u64>,
    ) -> Result<Self, SimulatorError> {
        let csv = CsvFile::create(&folder.join("latency.csv"), COLUMNS)?;
        Ok(Self { csv, charts: LatencyCharts::new(design, clock_hz) })
    }

    pub(super) fn push(&mut self, traffic: &FrameTraffic) {
        let clocks = |clock: Option<u64>| clock.map(|clock| clock.saturating_sub(traffic.since));
        let (decision, word) = (clocks(traffic.last_decision), clocks(traffic.last_word));
        let field = |value: Option<u64>| value.map_or_else(String::new, |value| value.to_string());
        self.csv.line([
            traffic.frame.to_string(),
            traffic.since.to_string(),
            field(decision),
            field(word),
            traffic.waiting_regions.to_string(),
            traffic.lost_regions.to_string(),
        ]);
        self.charts.push(traffic.frame, [decision, word], traffic.waiting_regions);
    }

    pub(super) fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.csv.write_out(all)
    }

    /// Completes the table, and draws the charts.
    pub(super) fn finish(mut self, folder: &Path) -> Result<(), SimulatorError> {
        self.csv.write_out(true)?;
        self.charts.write(folder)
    }
}
