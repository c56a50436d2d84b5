// SPDX-License-Identifier: MIT OR Apache-2.0
//! The recorder, which takes the outcome of every frame and writes it at once, so that memory is
//! bounded.

use std::cmp::Reverse;
use std::fs;
use std::path::Path;

use foveate_camera::Camera;
use foveate_design::Design;
use foveate_engine::{Engine, FrameOutcome};
use foveate_pixels::FramePixels;
use foveate_tools::SpaceReserve;
use rayon::prelude::*;

use super::arrays::ArraySink;
use super::clock_files::ClockFiles;
use super::data_set::{self, DataSetPaths};
use super::event_files;
use super::frame_packets::PacketFileSink;
use super::frame_table::{FrameRow, FrameTable};
use super::heatmap::HeatmapPainter;
use super::overlay::OverlayPainter;
use super::picture_series::PictureSeriesSink;
use super::pixel_event_files::PixelEventFiles;
use super::sink::{FrameSink, SinkFrame};
use super::summary::{RunTotals, SentCounts};
use super::{RunOptions, RunSummary};
use crate::SimulatorError;
use foveate_media::{LumaRange, SetForm, SourceFrame};
use foveate_tools::Interrupt;

/// The problem in the summary of a run that the user stopped.
pub(crate) const INTERRUPTED: &str = "interrupted";
/// The problem in the summary of a run on a full disk.
pub(crate) const DISK_FULL: &str = "disk full";
/// The number of bytes of an output that may wait in memory, besides those of its last frame.
const BUFFER_BYTES: u64 = 1 << 17;
/// The space in bytes that is reserved for a group of a Parquet file.
const GROUP_BYTES: u64 = 1 << 20;
/// The space in bytes that is reserved for the ends of the arrays and tables, the charts and the
/// summary.
const LAST_BYTES: u64 = 1 << 21;
/// The bytes of a pixel and of a region that may have to be written of the last frames.
const PIXEL_BYTES: u64 = 8;
const REGION_BYTES: u64 = 1 << 10;

/// The content of frames that not every run has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameContent {
    /// True if the scores of the regions are known.
    pub(crate) has_scores: bool,
    /// True if the versions of the maps of classes are known, as in a recording of a design with
    /// zones.
    pub(crate) has_map_versions: bool,
}

/// The open files of a run.
pub(crate) struct RunRecorder {
    design: Design,
    table: FrameTable,
    /// The pixel events. They are not among the sinks, because the summary needs their number.
    pixel_events: Option<PixelEventFiles>,
    /// The tables of clocks. They are not among the sinks, because the summary needs their figures.
    clocks: Option<ClockFiles>,
    sinks: Vec<Box<dyn FrameSink>>,
    data_set: Option<DataSetPaths>,
    totals: RunTotals,
    /// The disk space for what waits in memory when the disk is full.
    reserve: Option<SpaceReserve>,
    /// The disk space with which the files that are never left out are completed.
    last_reserve: SpaceReserve,
}

impl RunRecorder {
    pub(crate) fn create(
        folder: &Path,
        design: &Design,
        form: &SetForm,
        options: &RunOptions,
        content: FrameContent,
        interrupt: &Interrupt,
    ) -> Result<Self, SimulatorError> {
        let FrameContent { has_scores, has_map_versions } = content;
        let arrays = ArraySink::create(folder, design, has_scores)?;
        let mut sinks: Vec<Box<dyn FrameSink>> = vec![Box::new(arrays)];
        sinks.append(&mut event_files::event_sinks(folder, design, options.events, has_scores)?);
        if let Some(packets) = options.packets {
            sinks.push(Box::new(PacketFileSink::create(folder, design, packets)?));
        }
        if let Some(format) = options.rendered {
            sinks.push(Box::new(PictureSeriesSink::rendered(folder, format, interrupt)?));
        }
        if let Some(format) = options.overlay {
            let overlay = OverlayPainter::new(options.overlay_style, has_scores);
            sinks.push(Box::new(PictureSeriesSink::with_painter(
                folder,
                "overlay",
                (format, interrupt),
                overlay,
            )?));
        }
        if let Some(format) = options.heatmap {
            for (name, map) in HeatmapPainter::all_maps(design) {
                sinks.push(Box::new(PictureSeriesSink::with_painter(
                    folder,
                    &name,
                    (format, interrupt),
                    map,
                )?));
            }
        }
        let table = FrameTable::create(&folder.join("frames.csv"), design, has_map_versions)?;
        // The data set is last: its file names come from the inputs, and must not replace other
        // outputs.
        if options.data_set {
            sinks.append(&mut data_set::data_set_sinks(folder, form)?);
        }
        let clocks = &options.clocks;
        let clocks = clocks.is_wanted().then(|| ClockFiles::create(folder, design, clocks));
        let pixel_events = options.pixel_events;
        let pixel_events =
            pixel_events.is_wanted().then(|| PixelEventFiles::create(folder, design, pixel_events));
        let (clocks, pixel_events) = (clocks.transpose()?, pixel_events.transpose()?);
        let pixels = u64::from(design.width()) * u64::from(design.height());
        let frame_bytes = PIXEL_BYTES * pixels + REGION_BYTES * u64::from(design.regions());
        let owed: u64 = sinks.iter().map(|sink| BUFFER_BYTES + sink.max_bytes_owed(design)).sum();
        Ok(Self {
            table,
            data_set: options.data_set.then(|| DataSetPaths::of(form)),
            pixel_events,
            clocks,
            reserve: Some(SpaceReserve::new(folder, GROUP_BYTES + frame_bytes + owed)),
            last_reserve: SpaceReserve::new(folder, LAST_BYTES),
            sinks,
            totals: RunTotals::default(),
            design: design.clone(),
        })
    }

    /// Writes the outcome of one frame, which must be the last frame that `engine` took.
    pub(crate) fn push(
        &mut self,
        source: &SourceFrame,
        engine: &Engine,
        is_first: bool,
    ) -> Result<(), SimulatorError> {
        self.push_to_sinks(&SinkFrame::new(engine, self.totals.frames, source, is_first))
    }

    /// Writes a received frame with the screen after it. A design with zones has a version of its
    /// map of classes.
    pub(crate) fn push_received(
        &mut self,
        source: &SourceFrame,
        map_version: Option<u16>,
        outcome: &FrameOutcome,
        (camera, screen): (&Camera, FramePixels<'_>),
    ) -> Result<(), SimulatorError> {
        let number = self.totals.frames;
        self.push_to_sinks(&SinkFrame {
            camera,
            number,
            source,
            map_version,
            outcome,
            screen,
            is_first: false,
            engine: None,
        })
    }

    fn push_to_sinks(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        self.write_out()?;
        self.add_to_table(sink_frame);
        let Self { pixel_events: pixels, clocks, sinks, .. } = self;
        let ((pixels, clocks), sinks) = rayon::join(
            || {
                rayon::join(
                    || pixels.as_mut().map_or(Ok(()), |pixels| pixels.push(sink_frame)),
                    || clocks.as_mut().map_or(Ok(()), |clocks| clocks.push(sink_frame)),
                )
            },
            || sinks.par_iter_mut().try_for_each(|sink| sink.push(sink_frame)),
        );
        pixels.and(clocks).and(sinks)
    }

    /// Writes the buffered data if there is much of it. On a full disk the data stays in memory,
    /// and every file has the same frames.
    fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.table.write_pending()?;
        self.pixel_events.as_mut().map_or(Ok(()), PixelEventFiles::write_out)?;
        self.clocks.as_mut().map_or(Ok(()), ClockFiles::write_out)?;
        self.sinks.iter_mut().try_for_each(|sink| sink.write_out())
    }

    /// Completes every file and adds the summary. `problem` is the reason why the run ended early,
    /// if it did. On a full disk the reserved space is released, and the expendable outputs are
    /// left out as far as necessary: pictures, Parquet tables, videos. A video is also left out if
    /// its ffmpeg was interrupted.
    pub(crate) fn finish(
        mut self,
        folder: &Path,
        (inputs, luma): (&[String], Option<LumaRange>),
        mut problem: Option<String>,
    ) -> Result<RunSummary, SimulatorError> {
        let interrupted = problem.as_deref() == Some(INTERRUPTED);
        let may_leave_out = |error: &SimulatorError| {
            let video = matches!(error, SimulatorError::VideoOutput { .. });
            error.is_full() || (interrupted && video)
        };
        let mut clock_table = self.clocks.as_mut().and_then(ClockFiles::end);
        let (mut expendable, needed) = std::mem::take(&mut self.sinks)
            .into_iter()
            .partition::<Vec<_>, _>(|sink| sink.expendable_path().is_some());
        self.sinks = needed;
        // Pictures are first, because the reserve has room for them.
        expendable.sort_by_key(|sink| Reverse(sink.max_bytes_owed(&self.design)));
        drop(self.reserve.take());
        while let Err(error) = self.write_out() {
            // The file is closed when its sink is dropped.
            let path = expendable.pop().and_then(|sink| sink.expendable_path());
            let path = path.or_else(|| clock_table.take().map(|table| table.path()));
            let path = path.filter(|_| error.is_full()).ok_or(error)?;
            leave_out(&path, &mut problem);
        }
        let mut complete = |path: &Path, finished: Result<(), SimulatorError>| match finished {
            Err(error) if may_leave_out(&error) => {
                leave_out(path, &mut problem);
                Ok(())
            }
            finished => finished,
        };
        for sink in expendable {
            let path = sink.expendable_path().unwrap_or_default();
            complete(&path, sink.finish())?;
        }
        if let Some(table) = clock_table {
            complete(&table.path(), table.finish())?;
        }
        drop(self.last_reserve);
        self.table.finish()?;
        self.sinks.into_iter().try_for_each(|sink| sink.finish())?;
        let pixel_events = self.pixel_events.map(PixelEventFiles::finish).transpose()?;
        let clocks = self.clocks.map(ClockFiles::finish).transpose()?;
        let summary = RunSummary {
            luma: luma.map(LumaRange::name),
            clocks,
            data_set: self.data_set,
            ..self.totals.summary(&self.design, inputs, problem, pixel_events)
        };
        summary.write(&folder.join("summary.json"))?;
        Ok(summary)
    }

    /// Returns the number of frames so far.
    pub(crate) fn frames(&self) -> u64 {
        self.totals.frames
    }

    fn add_to_table(&mut self, sink_frame: &SinkFrame<'_>) {
        let SinkFrame { source, map_version, outcome, .. } = *sink_frame;
        let (srs, trs) = (count_set(&outcome.srs), count_set(&outcome.trs));
        let active = count_set(&outcome.active);
        let sent = SentCounts::of_actions(&self.design, &outcome.actions);
        let (frame, time_us, name) = (self.totals.frames, source.time_us, source.name.as_str());
        let label = source.label.as_deref();
        self.totals.add(srs, trs, active, sent);
        self.totals.record_time(time_us);
        self.table.push(&FrameRow {
            frame,
            time_us,
            name,
            label,
            srs,
            trs,
            active,
            sent,
            map_version,
        });
    }
}

/// Removes a file or a folder of pictures that cannot be completed, and names it in the problem of
/// the run.
fn leave_out(path: &Path, problem: &mut Option<String>) {
    // The path lies in the folder of this run. If it cannot be removed, the summary still names it.
    let _ = fs::remove_file(path).or_else(|_| fs::remove_dir_all(path));
    let name = path.file_name().expect("an output has a name").display();
    let earlier = problem.as_deref().unwrap_or(DISK_FULL);
    *problem = Some(format!("{earlier}; {name} is left out"));
}

fn count_set(bits: &[bool]) -> u64 {
    bits.iter().map(|&bit| u64::from(bit)).sum()
}
