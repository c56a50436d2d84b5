// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file `summary.json`: the run and its results on one page.

use std::path::Path;

use foveate_camera::{Camera, RegionAction};
use foveate_design::{Design, DesignConfig};
use serde::Serialize;

use super::bandwidth::{BandwidthComparison, TrafficSums};
use super::cannot_write;
use super::clock_files::ClockFigures;
use super::data_set::DataSetPaths;
use crate::SimulatorError;

/// The version of the format. It changes when a key of the summary changes its meaning or is
/// removed.
const FORMAT_VERSION: u32 = 1;

/// The numbers of columns and rows of regions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct GridSize {
    /// The number of columns of regions.
    pub columns: u32,
    /// The number of rows of regions.
    pub rows: u32,
}

/// The smallest and the largest value of a series.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ValueRange {
    /// The smallest value.
    pub min: f64,
    /// The largest value.
    pub max: f64,
}

/// The summary of a run. Shares refer to all regions of all frames, and are rounded to six digits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunSummary {
    /// The version of this format.
    pub format_version: u32,
    /// The version of the program.
    pub foveate_version: &'static str,
    /// The fingerprint of the design.
    pub design_fingerprint: String,
    /// True if there was no problem: the source was run to its end, and every output is complete.
    pub complete: bool,
    /// The reason why the run is not complete.
    pub problem: Option<String>,
    /// The inputs as they were given.
    pub inputs: Vec<String>,
    /// The range of the luma of video: `coded` or `full`. Other inputs have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub luma: Option<&'static str>,
    /// The number of frames.
    pub frames: u64,
    /// The frame width in pixels.
    pub width: u32,
    /// The frame height in pixels.
    pub height: u32,
    /// The bits per pixel.
    pub pixel_bits: u32,
    /// The grid of regions.
    pub grid: GridSize,
    /// The number of regions of a frame.
    pub regions: u32,
    /// The share of active regions.
    pub active_share: f64,
    /// The share of regions with SRS.
    pub srs_share: f64,
    /// The share of regions with TRS.
    pub trs_share: f64,
    /// The share of active regions in the frame with the fewest and in the frame with the most of
    /// them.
    pub active_share_per_frame: ValueRange,
    /// The number of pixels of all frames.
    pub pixels_in: u64,
    /// The number of pixels of all active regions, without the padding of ragged frames.
    pub pixels_forwarded: u64,
    /// The number of summaries that were sent. It exists only for a camera whose irrelevant regions
    /// send their means.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub summaries_sent: Option<u64>,
    /// The number of means in these summaries.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub means_sent: Option<u64>,
    /// The bytes and events that the kinds of camera send.
    pub bandwidth: BandwidthComparison,
    /// The figures in clocks, if they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clocks: Option<ClockFigures>,
    /// The data set that was made, if one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub data_set: Option<DataSetPaths>,
    /// The configuration, with the frame size filled in.
    pub configuration: DesignConfig,
}

/// The data that is sent of one frame, or of many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SentCounts {
    /// The number of pixels, without the padding of ragged frames.
    pub pixels: u64,
    /// The number of summaries.
    pub summaries: u64,
    /// The number of means in these summaries.
    pub means: u64,
}

impl SentCounts {
    /// Counts what the regions of a frame send, given their actions in order.
    #[must_use]
    pub fn of_actions(camera: &Camera, actions: &[RegionAction]) -> Self {
        let mut sent = Self::default();
        for (region, &action) in (0..).zip(actions) {
            let values = camera.values_sent(region, action);
            match action {
                RegionAction::Forward => sent.pixels += values,
                RegionAction::Summarize => {
                    sent.summaries += 1;
                    sent.means += values;
                }
                RegionAction::Hold | RegionAction::Blank => {}
            }
        }
        sent
    }
}

/// The sums over the frames so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RunTotals {
    pub(super) frames: u64,
    pub(super) srs: u64,
    pub(super) trs: u64,
    pub(super) active: u64,
    pub(super) sent: SentCounts,
    /// The times of the first and of the last frame in microseconds.
    pub(super) times: Option<(u64, u64)>,
    /// The number of active regions in the frame with the fewest and in the frame with the most of
    /// them.
    pub(super) extremes: Option<(u64, u64)>,
}

impl RunTotals {
    pub(super) fn add(&mut self, srs: u64, trs: u64, active: u64, sent: SentCounts) {
        self.frames += 1;
        self.srs += srs;
        self.trs += trs;
        self.active += active;
        self.sent.pixels += sent.pixels;
        self.sent.summaries += sent.summaries;
        self.sent.means += sent.means;
        let (min, max) = self.extremes.unwrap_or((active, active));
        self.extremes = Some((min.min(active), max.max(active)));
    }

    /// Records the time of a frame.
    pub(super) fn record_time(&mut self, time_us: u64) {
        self.times = Some((self.times.map_or(time_us, |(first, _)| first), time_us));
    }

    pub(super) fn summary(
        &self,
        design: &Design,
        inputs: &[String],
        problem: Option<String>,
        pixel_events: Option<u64>,
    ) -> RunSummary {
        let sums = TrafficSums {
            frames: self.frames,
            events: self.active + self.sent.summaries,
            values: self.sent.pixels + self.sent.means,
            pixel_events,
            times: self.times,
        };
        let regions = u64::from(design.regions());
        let all = regions * self.frames;
        let (min, max) = self.extremes.expect("a run without a frame has no summary");
        RunSummary {
            format_version: FORMAT_VERSION,
            foveate_version: env!("CARGO_PKG_VERSION"),
            design_fingerprint: design.fingerprint(),
            complete: problem.is_none(),
            problem,
            inputs: inputs.to_vec(),
            luma: None,
            frames: self.frames,
            width: design.width(),
            height: design.height(),
            pixel_bits: design.pixel_bits(),
            grid: GridSize { columns: design.columns(), rows: design.rows() },
            regions: design.regions(),
            active_share: share(self.active, all),
            srs_share: share(self.srs, all),
            trs_share: share(self.trs, all),
            active_share_per_frame: ValueRange {
                min: share(min, regions),
                max: share(max, regions),
            },
            pixels_in: self.frames * u64::from(design.width()) * u64::from(design.height()),
            pixels_forwarded: self.sent.pixels,
            summaries_sent: design.periphery().map(|_| self.sent.summaries),
            means_sent: design.periphery().map(|_| self.sent.means),
            bandwidth: BandwidthComparison::of(design, &sums),
            clocks: None,
            data_set: None,
            configuration: design.config(),
        }
    }
}

impl RunSummary {
    /// Returns the summary as a JSON document.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("plain data with text keys") + "\n"
    }

    pub(super) fn write(&self, path: &Path) -> Result<(), SimulatorError> {
        std::fs::write(path, self.to_json()).map_err(cannot_write(path))
    }
}

/// Returns `part / whole`, rounded to six digits after the point, so that it is the same on every
/// machine.
fn share(part: u64, whole: u64) -> f64 {
    const UNIT: u128 = 1_000_000;
    let whole = u128::from(whole.max(1));
    let millionths = (u128::from(part) * UNIT + whole / 2) / whole;
    f64::from(u32::try_from(millionths).expect("a part is no more than the whole")) / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_rounded_to_six_digits() {
        assert!((share(1, 3) - 0.333_333).abs() < 1e-12);
        assert!((share(2, 3) - 0.666_667).abs() < 1e-12);
        assert_eq!((share(0, 0), share(7, 7)).0.to_string(), "0");
        assert_eq!(share(7, 7).to_string(), "1");
    }
}
