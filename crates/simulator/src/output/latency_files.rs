// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file `latency.csv`, with the latency of every frame, and charts of it and of the regions
//! that wait, over a clip of any length.

use super::csv::CsvFile;
use crate::SimulatorError;
use foveate_design::Design;
use foveate_output::chart::{Chart, ChartData, ChartSeries};
use foveate_timed::FrameTraffic;
use std::path::Path;

const COLUMNS: &str = "frame,clock,decision_clocks,word_clocks,waiting_regions,lost_regions";

/// The open table, and the charts so far.
pub(super) struct LatencyFiles {
    csv: CsvFile,
    charts: LatencyCharts,
}

impl LatencyFiles {
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

    pub(super) fn write_pending(&mut self) -> Result<(), SimulatorError> {
        self.csv.write_pending()
    }

    /// Completes the table, and draws the charts.
    pub(super) fn finish(mut self, folder: &Path) -> Result<(), SimulatorError> {
        self.csv.write_all()?;
        self.charts.write(folder)
    }
}

/// The largest number of points of a line.
const MAX_POINTS: usize = 500;

/// The largest values of a few neighboring frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct FramePeaks {
    /// The clocks to the last decision and to the last word, if there is one.
    latencies: [Option<u64>; 2],
    waiting: u64,
}

impl FramePeaks {
    fn merge(self, other: Self) -> Self {
        let [decision, word] = self.latencies;
        Self {
            latencies: [decision.max(other.latencies[0]), word.max(other.latencies[1])],
            waiting: self.waiting.max(other.waiting),
        }
    }
}

/// The lines of the charts. A point is a frame until a line has the largest number of points; then
/// it is the largest value of 2, 4, 8 frames and so on. So memory is constant.
pub(super) struct LatencyCharts {
    caption: String,
    clock_hz: Option<u64>,
    frames_per_point: u64,
    points: Vec<FramePeaks>,
}

impl LatencyCharts {
    pub(super) fn new(design: &Design, clock_hz: Option<u64>) -> Self {
        let clock = clock_hz.map_or_else(String::new, |hertz| format!(" · {hertz} Hz"));
        let version = env!("CARGO_PKG_VERSION");
        Self {
            caption: format!(
                "foveate {version} simulate --clocks · design {}{clock}",
                design.fingerprint()
            ),
            clock_hz,
            frames_per_point: 1,
            points: Vec::new(),
        }
    }

    /// Adds the next frame.
    pub(super) fn push(&mut self, frame: u64, latencies: [Option<u64>; 2], waiting: u64) {
        let peaks = FramePeaks { latencies, waiting };
        let place = usize::try_from(frame / self.frames_per_point).unwrap_or(usize::MAX);
        match self.points.get_mut(place) {
            Some(point) => *point = point.merge(peaks),
            None => self.points.push(peaks),
        }
        if self.points.len() > MAX_POINTS {
            let merge = |pair: &[FramePeaks]| pair.iter().copied().reduce(FramePeaks::merge);
            self.points = self.points.chunks(2).filter_map(merge).collect();
            self.frames_per_point *= 2;
        }
    }

    /// Writes the charts, as SVG and PNG. A clip without frames has none.
    pub(super) fn write(&self, folder: &Path) -> Result<(), SimulatorError> {
        if self.points.is_empty() {
            return Ok(());
        }
        for chart in [self.latency_chart(), self.waiting_chart()] {
            let path = |extension| folder.join(format!("{}.{extension}", chart.file_stem));
            let write = |path, bytes: &[u8]| {
                std::fs::write(&path, bytes)
                    .map_err(|source| SimulatorError::Write { path, source })
            };
            write(path("svg"), chart.to_svg(&[])?.as_bytes())?;
            write(path("png"), &chart.to_png()?)?;
        }
        Ok(())
    }

    fn latency_chart(&self) -> Chart {
        let unit = if self.clock_hz.is_some() { "ms" } else { "clocks" };
        let line = |name: &str, place: usize| {
            self.line(name, |point| Some(self.duration(point.latencies[place]?)))
        };
        self.chart(
            "latency",
            "From a frame to its last decision and its last word",
            format!("{unit} since the frame came"),
            vec![line("last decision", 0), line("last word", 1)],
        )
    }

    fn waiting_chart(&self) -> Chart {
        self.chart(
            "waiting",
            "Regions that are decided and have not left",
            "largest number of regions".to_owned(),
            vec![self.line("waiting regions", |point| Some(coordinate(point.waiting)))],
        )
    }

    fn chart(&self, file: &str, title: &str, y_title: String, lines: Vec<ChartSeries>) -> Chart {
        let x_title = match self.frames_per_point {
            1 => "frame".to_owned(),
            frames => format!("frame (a point is the largest value of {frames} frames)"),
        };
        Chart {
            file_stem: file.to_owned(),
            title: title.to_owned(),
            x_title,
            y_title,
            caption: self.caption.clone(),
            shape: ChartData::Lines(lines),
        }
    }

    /// Makes a line from a value of each point.
    fn line(&self, name: &str, value: impl Fn(&FramePeaks) -> Option<f64>) -> ChartSeries {
        let frames = (0..).map(|place| coordinate(place * self.frames_per_point));
        let points = frames.zip(&self.points).filter_map(|(x, point)| Some((x, value(point)?)));
        ChartSeries { name: name.to_owned(), points: points.collect(), ..ChartSeries::default() }
    }

    /// Converts clocks to milliseconds, if the clock is known.
    fn duration(&self, clocks: u64) -> f64 {
        match self.clock_hz {
            Some(hertz) => 1000.0 * coordinate(clocks) / coordinate(hertz),
            None => coordinate(clocks),
        }
    }
}

#[allow(clippy::cast_precision_loss, reason = "a coordinate of a chart")]
fn coordinate(value: u64) -> f64 {
    value as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_design::DesignConfig;

    #[test]
    fn a_long_clip_keeps_its_largest_values_in_few_points() {
        let design = DesignConfig::default().validate().unwrap();
        let mut charts = LatencyCharts::new(&design, None);
        for frame in 0..10_000 {
            let peak = if frame == 7001 { 500 } else { 10 };
            charts.push(frame, [Some(peak), (frame >= 5000).then_some(peak + 1)], frame % 7);
        }
        assert_eq!(charts.frames_per_point, 32);
        assert_eq!(charts.points.len(), 10_000_usize.div_ceil(32));
        let latencies: Vec<_> = charts.points.iter().map(|point| point.latencies).collect();
        assert_eq!(latencies[7001 / 32], [Some(500), Some(501)]);
        assert_eq!(latencies[7001 / 32 + 1], [Some(10), Some(11)]);
        assert_eq!(latencies[0], [Some(10), None]);
        assert!(charts.points.iter().all(|point| point.waiting == 6));
    }

    #[test]
    fn clocks_become_milliseconds_if_the_clock_is_known() {
        let design = DesignConfig::default().validate().unwrap();
        let charts = LatencyCharts::new(&design, Some(50_000_000));
        assert!((charts.duration(100_000) - 2.0).abs() < 1e-12);
        assert!((LatencyCharts::new(&design, None).duration(7) - 7.0).abs() < 1e-12);
    }
}
