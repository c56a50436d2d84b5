// SPDX-License-Identifier: MIT OR Apache-2.0
//! The report of a comparison ([`LinkReport`]): as it is in the JSON file, as Markdown for
//! people, where a kB is 1000 bytes, and as charts of bytes against quality ([`charts`]), for
//! the design's thresholds and the codecs' quantizers. A [`RowRecord`] collects what it says
//! about a raster core: the edges at which each row of regions leaves, and the regions that are
//! lost.

use crate::link::{LinkFigures, Quality, UnbufferedFigures};
use foveate_design::Design;
use foveate_output::chart::{Chart, ChartData, ChartSeries, LineLook};
use foveate_output::report::{Report, ReportPart, ReportTable};
use foveate_timed::Transaction;
use serde::Serialize;

/// The version of the JSON format; it changes if a key changes its meaning or is removed.
pub(crate) const FORMAT_VERSION: u32 = 3;

/// The name of the setting that a codec's curve varies.
pub(crate) const QUANTIZER: &str = "quantizer";

/// The report of a comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LinkReport {
    /// The version of the JSON format.
    pub format_version: u32,
    /// The version of the program.
    pub foveate_version: &'static str,
    /// The version banner of ffmpeg.
    pub ffmpeg: String,
    /// The preset of x264 and x265.
    pub effort: &'static str,
    /// The range of the luma of clips that are video: `coded` or `full`.
    pub luma: &'static str,
    /// The rate of the link in bits per second.
    pub link_bits_per_second: u64,
    /// The clock of the array in Hz. Without one, the array takes no time.
    pub clock_hz: Option<u64>,
    /// The clips, in the order of the inputs.
    pub clips: Vec<ClipReport>,
}

/// The report of one clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClipReport {
    /// The name of the clip.
    pub name: String,
    /// The inputs as the user named them.
    pub inputs: Vec<String>,
    /// The reason why the clip ended early, if it did.
    pub problem: Option<String>,
    /// The fingerprint of the design.
    pub design: String,
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
    /// The number of frames.
    pub frames: u64,
    /// The time from the first frame to the end of the last frame, in ns.
    pub duration_ns: u64,
    /// The most clocks that the array adds to a time after the pixels that it waits for have been
    /// read. The clocks of a raster core are those of this clip, at the clock of the array, or
    /// without one at the slowest that keeps up.
    pub array_clocks: u64,
    /// The slowest clock in Hz at which the array keeps up with the frames.
    pub needed_clock_hz: u64,
    /// The senders: cameras, then codecs.
    pub senders: Vec<SenderReport>,
    /// The points of bytes against quality.
    pub curves: Vec<CurvePoint>,
}

/// The report of one sender of a clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SenderReport {
    /// The name of the sender.
    pub sender: &'static str,
    /// The figure in which a codec must equal the region camera, `psnr` or `ssim`; `None` for a
    /// camera.
    pub equal: Option<&'static str>,
    /// The quantizer of a codec.
    pub quantizer: Option<u32>,
    /// The result of the search for a codec's quantizer. `equal` is the coarsest quantizer that is
    /// good enough; `finest` did not reach the quality of the region camera; `coarsest` is still
    /// better.
    #[serde(rename = "found")]
    pub search_result: Option<&'static str>,
    /// The quality of the receiver's frames; `None` for a sender without frames.
    pub quality: Option<Quality>,
    /// The load on the link.
    pub figures: LinkFigures,
    /// The figures without a buffer between array and link; only for the array of a raster design.
    pub unbuffered: Option<UnbufferedFigures>,
}

/// A point of a curve.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CurvePoint {
    /// The name of the sender.
    pub sender: &'static str,
    /// The setting that differs from point to point: a key of the design, or the quantizer.
    #[serde(rename = "knob")]
    pub setting: &'static str,
    /// The value of the setting.
    pub value: u64,
    /// The bytes per second.
    pub bytes_per_second: u64,
    /// The quality of the receiver's frames.
    pub quality: Quality,
}

impl LinkReport {
    /// Returns the reasons why clips ended early, with their names.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let problem = |clip: &ClipReport| {
            clip.problem.as_ref().map(|problem| format!("{}: {problem}", clip.name))
        };
        self.clips.iter().filter_map(problem).collect()
    }
}

/// The output of a row of regions of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct RowOutput {
    /// The clock of the last decision.
    pub(crate) last_decision: u64,
    /// The clock of the last word that leaves, or `None` if none does.
    pub(crate) last_word: Option<u64>,
    /// The number of pixels and means that the regions send, without padding.
    pub(crate) values: u64,
}

/// The output of the rows of regions of all frames.
#[derive(Clone, Debug)]
pub(crate) struct RowRecord<'a> {
    pub(crate) design: &'a Design,
    /// The rows of regions, frame by frame.
    rows: Vec<RowOutput>,
    pub(crate) lost_regions: u64,
    /// The numbers of the frames of these regions, in ascending order.
    pub(crate) frames_with_losses: Vec<u64>,
}

impl<'a> RowRecord<'a> {
    pub(crate) fn new(design: &'a Design) -> Self {
        Self { design, rows: Vec::new(), lost_regions: 0, frames_with_losses: Vec::new() }
    }

    /// Records a transaction of the core.
    pub(crate) fn add(&mut self, transaction: &Transaction<'_>) {
        match transaction {
            Transaction::Decisions(run) => {
                for (clock, region) in run.regions.iter() {
                    let action = run.outcome.actions[region as usize];
                    let values = self.design.values_sent(region, action);
                    let row = self.row(run.frame, region);
                    row.last_decision = row.last_decision.max(clock);
                    row.values += values;
                }
            }
            Transaction::Words(run) => {
                for (first, region) in run.senders() {
                    let last = run.last_clock(first);
                    let row = self.row(run.frame, region);
                    row.last_word = row.last_word.max(Some(last));
                }
            }
            Transaction::Loss(loss) => {
                self.lost_regions += 1;
                if self.frames_with_losses.last() != Some(&loss.frame) {
                    self.frames_with_losses.push(loss.frame);
                }
            }
            Transaction::Scores(_) | Transaction::SyncError { .. } => {}
        }
    }

    /// Returns the output of every row of regions, with the numbers of its frame and row.
    pub(crate) fn outputs(&self) -> impl Iterator<Item = ((u64, u32), &RowOutput)> {
        let rows = self.design.rows();
        let places = (0_u64..).flat_map(move |frame| (0..rows).map(move |row| (frame, row)));
        places.zip(&self.rows)
    }

    fn row(&mut self, frame: u64, region: u32) -> &mut RowOutput {
        let row = frame * u64::from(self.design.rows()) + u64::from(region / self.design.columns());
        let place = usize::try_from(row).expect("rows are in memory");
        if place >= self.rows.len() {
            self.rows.resize(place + 1, RowOutput::default());
        }
        &mut self.rows[place]
    }
}

const COLUMNS: [&str; 14] = [
    "sender",
    "equal",
    "quantizer",
    "PSNR [dB]",
    "SSIM",
    "kB/s",
    "x region",
    "1 ms: p99, peak",
    "10 ms",
    "100 ms",
    "largest frame [kB]",
    "decision [ms]",
    "last byte: median, longest [ms]",
    "buffer [kB]",
];

impl LinkReport {
    /// Returns a table per clip. The rates of windows are in kB/s.
    #[must_use]
    pub fn markdown(&self) -> String {
        Report(self.clips.iter().flat_map(|clip| self.clip_parts(clip)).collect()).markdown()
    }

    fn clip_parts(&self, clip: &ClipReport) -> [ReportPart; 3] {
        let heading = format!(
            "{}: {} frames of {} x {} pixels in {} ms, link {} kB/s{}",
            clip.name,
            clip.frames,
            clip.width,
            clip.height,
            clip.duration_ns / 1_000_000,
            thousands_text(self.link_bits_per_second / 8),
            if clip.problem.is_some() { ", NOT COMPLETE" } else { "" },
        );
        let unbuffered = clip.senders.iter().filter_map(|sender| sender.unbuffered.as_ref());
        let notes = unbuffered.map(|figures| unbuffered_text(clip, figures)).collect();
        let rows = clip.senders.iter().map(|sender| row(clip, sender));
        let table = ReportTable { words: 2, notes, ..ReportTable::new(COLUMNS, rows) };
        let [heading, clock] = [heading, self.clock(clip)].map(ReportPart::Paragraph);
        [heading, clock, ReportPart::Table(table)]
    }

    /// Describes the clock of the array, or the clocks that are left out without one.
    fn clock(&self, clip: &ClipReport) -> String {
        match self.clock_hz {
            Some(hertz) => format!("The array runs at {} MHz.", millions_text(hertz)),
            None => format!(
                "Without --clock: at {} MHz, the slowest clock that keeps up, the array adds up to {} clocks to the times of the region camera.",
                millions_text(clip.needed_clock_hz),
                clip.array_clocks
            ),
        }
    }
}

/// Describes an array that gives its words to the link without a buffer.
fn unbuffered_text(clip: &ClipReport, figures: &UnbufferedFigures) -> String {
    format!(
        "Without a buffer behind the array, at {} MHz, {}. The link takes the last word of a row of regions at most {} ms after its oldest pixel was read.",
        millions_text(figures.clock_hz),
        figures.losses_text(clip.frames),
        milliseconds_text(figures.last_word_ns)
    )
}

impl UnbufferedFigures {
    /// Describes the regions that are lost in a clip of so many frames, for people.
    #[must_use]
    pub fn losses_text(&self, frames: u64) -> String {
        match self.frames_with_losses[..] {
            [] => "no region is lost".to_owned(),
            [first, ..] => format!(
                "lost regions: {}, in {} of {frames} frames, first in frame {first}",
                self.lost_regions,
                self.frames_with_losses.len(),
            ),
        }
    }
}

/// Formats ns as ms with three decimals; further digits are cut off.
#[must_use]
pub fn milliseconds_text(ns: u64) -> String {
    thousandths_text(ns / 1000, 3)
}

/// Formats millions exactly, as MHz or Mbit.
pub(crate) fn millions_text(value: u64) -> String {
    let digits = format!("{}.{:06}", value / 1_000_000, value % 1_000_000);
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn row(clip: &ClipReport, sender: &SenderReport) -> [String; COLUMNS.len()] {
    let figures = &sender.figures;
    let [one, ten, hundred] = figures
        .windows
        .map(|rates| format!("{}, {}", thousands_text(rates.p99), thousands_text(rates.peak)));
    let delivery = figures.delivery_ns;
    let grows = if figures.overloaded { "grows: " } else { "" };
    let ms = milliseconds_text;
    [
        sender.sender.to_owned(),
        sender.equal.map_or("-".to_owned(), str::to_uppercase),
        quantizer(sender),
        psnr(sender),
        sender.quality.map_or("-".to_owned(), |quality| format!("{:.4}", quality.ssim)),
        thousands_text(figures.bytes_per_second),
        ratio(clip, sender),
        one,
        ten,
        hundred,
        thousands_text(figures.largest_frame_bytes),
        ms(figures.decision_ns),
        format!("{}, {}", ms(delivery.median), ms(delivery.longest)),
        format!("{grows}{}", thousands_text(figures.buffer_bytes)),
    ]
}

fn quantizer(sender: &SenderReport) -> String {
    let Some(quantizer) = sender.quantizer else { return "-".to_owned() };
    match sender.search_result {
        Some("finest") => format!("{quantizer}: not reached"),
        Some("coarsest") => format!("{quantizer}: still better"),
        _ => quantizer.to_string(),
    }
}

fn psnr(sender: &SenderReport) -> String {
    sender.quality.map_or("-".to_owned(), |quality| {
        quality.psnr.map_or("equal".to_owned(), |psnr| format!("{psnr:.2}"))
    })
}

/// Formats the bytes as a multiple of those of the region camera.
fn ratio(clip: &ClipReport, sender: &SenderReport) -> String {
    let own = clip.senders.iter().find(|sender| sender.sender.starts_with("region"));
    #[allow(clippy::cast_precision_loss, reason = "shown with three decimals")]
    let ratio = own.map(|own| sender.figures.bytes as f64 / own.figures.bytes.max(1) as f64);
    ratio.map_or(String::new(), |ratio| format!("{ratio:.3}"))
}

/// Formats thousands with one decimal, rounded to the nearest.
fn thousands_text(value: u64) -> String {
    thousandths_text((value + 50) / 100 * 100, 1)
}

/// Formats thousandths with one to three decimals; further digits are cut off.
fn thousandths_text(value: u64, decimals: usize) -> String {
    let thousandths = format!("{:03}", value % 1000);
    format!("{}.{}", value / 1000, &thousandths[..decimals])
}

/// A chart: its file name, the title of its y axis, and the figure of a quality on that axis.
type QualityChart = (&'static str, &'static str, fn(&Quality) -> Option<f64>);

const VIEWS: [QualityChart; 2] = [
    ("rate-distortion", "PSNR of the receiver's screen [dB]", |quality| quality.psnr),
    ("rate-distortion-ssim", "SSIM of the receiver's screen", |quality| Some(quality.ssim)),
];

/// Draws the charts of a clip; `suffix` is added to their file names.
pub(crate) fn charts(clip: &ClipReport, suffix: &str) -> Vec<Chart> {
    let chart = |&(file, y, part): &QualityChart| Chart {
        file_stem: format!("{file}{suffix}"),
        title: format!("Bytes against quality: {}", clip.name),
        x_title: "bytes per second (logarithmic)".to_owned(),
        y_title: y.to_owned(),
        caption: caption(clip),
        shape: ChartData::LogLines(lines(clip, part)),
    };
    VIEWS.iter().map(chart).collect()
}

fn caption(clip: &ClipReport) -> String {
    let incomplete = if clip.problem.is_some() { " · NOT COMPLETE" } else { "" };
    format!(
        "foveate {} link · design {} · {} frames of {}x{} pixels{incomplete}",
        env!("CARGO_PKG_VERSION"),
        clip.design,
        clip.frames,
        clip.width,
        clip.height
    )
}

/// Returns a line for each codec and each threshold, in the order of the points, and the design as
/// the last line, drawn above all others. Identical frames have no PSNR, and so no point in that
/// chart.
fn lines(clip: &ClipReport, part: fn(&Quality) -> Option<f64>) -> Vec<ChartSeries> {
    let place = |bytes: u64, quality: &Quality| Some((coordinate(bytes), part(quality)?));
    let own = clip.senders.iter().find(|sender| sender.sender.starts_with("region"));
    let own = own.and_then(|own| place(own.figures.bytes_per_second, own.quality.as_ref()?));
    let mut lines: Vec<ChartSeries> = Vec::new();
    let of_codecs = clip.curves.iter().filter(|point| point.setting == QUANTIZER);
    let of_thresholds = clip.curves.iter().filter(|point| point.setting != QUANTIZER);
    for point in of_codecs.chain(of_thresholds) {
        let name = name(point);
        if lines.last().is_none_or(|line| line.name != name) {
            lines.push(ChartSeries { name, ..ChartSeries::default() });
        }
        let line = lines.last_mut().expect("one has just been added");
        line.points.extend(place(point.bytes_per_second, &point.quality));
    }
    let points = own.into_iter().collect();
    lines.push(ChartSeries { name: "this design".to_owned(), points, look: LineLook::Target });
    lines
}

fn name(point: &CurvePoint) -> String {
    match point.setting {
        QUANTIZER => point.sender.to_owned(),
        key => key.to_owned(),
    }
}

/// Converts a rate to a coordinate above 0, because the axis is logarithmic.
#[allow(clippy::cast_precision_loss, reason = "a coordinate of a chart")]
fn coordinate(rate: u64) -> f64 {
    rate.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_rounded_and_thousandths_are_cut() {
        assert_eq!([0, 49, 50, 12_345].map(thousands_text), ["0.0", "0.0", "0.1", "12.3"]);
        assert_eq!([thousandths_text(1_002, 3), thousandths_text(999, 1)], ["1.002", "0.9"]);
    }
}
