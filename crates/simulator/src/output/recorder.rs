// SPDX-License-Identifier: MIT OR Apache-2.0
//! The recorder, which takes the outcome of every frame and writes it at once, so that memory is
//! bounded.

use std::path::{Path, PathBuf};

use foveate_camera::Camera;
use foveate_design::Design;
use foveate_engine::{Engine, FrameOutcome};
use foveate_pixels::FramePixels;
use foveate_tools::SpaceReserve;
use rayon::prelude::*;

use super::clock_files::ClockFiles;
use super::data_set::{self, DataSetPaths};
use super::frame_packets::PacketFileSink;
use super::frame_table::{FrameRow, FrameTable};
use super::heatmap::HeatmapPainter;
use super::npz::ArraySink;
use super::overlay::OverlayPainter;
use super::picture_series::PictureSeriesSink;
use super::pixel_event_files::PixelEventFiles;
use super::sink::{FrameSink, SinkFrame};
use super::summary::{RunTotals, SentCounts};
use super::{RunOptions, RunSummary, pixel_event_files};
use crate::SimulatorError;
use foveate_media::{LumaRange, SetForm, SourceFrame};
use foveate_tools::Interrupt;

/// The problem in the summary of a run that the user stopped.
pub(crate) const INTERRUPTED: &str = "interrupted";
/// The problem in the summary of a run on a full disk.
pub(crate) const DISK_FULL: &str = "disk full";
/// The number of bytes of an output that may wait in memory, besides those of its last frame.
const BUFFER_BYTES: u64 = 1 << 17;
/// The space in bytes that is reserved for the summary, and for outputs that buffer much, such as a
/// group of a Parquet file.
const MIN_RESERVE_BYTES: u64 = 1 << 20;

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
    /// The disk space with which every file except a video can be completed on a full disk.
    reserve: Option<SpaceReserve>,
    /// The disk space with which ffmpeg can complete a video.
    video_reserve: Option<SpaceReserve>,
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
        sinks.append(&mut pixel_event_files::event_sinks(
            folder,
            design,
            options.events,
            has_scores,
        )?);
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
        let owed_bytes: u64 =
            sinks.iter().map(|sink| BUFFER_BYTES + sink.max_bytes_owed(design)).sum();
        let clocks = &options.clocks;
        let clocks = clocks.is_wanted().then(|| ClockFiles::create(folder, design, clocks));
        let clocks = clocks.transpose()?;
        let owed_by_clocks = clocks.as_ref().map_or(0, |_| ClockFiles::max_bytes_owed(design));
        let has_video = sinks.iter().any(|sink| sink.is_written_by_other_program());
        let video_reserve =
            has_video.then(|| SpaceReserve::new(folder, ".spare", MIN_RESERVE_BYTES));
        let pixel_events = options.pixel_events;
        let pixel_events =
            pixel_events.is_wanted().then(|| PixelEventFiles::create(folder, design, pixel_events));
        Ok(Self {
            table,
            data_set: options.data_set.then(|| DataSetPaths::of(form)),
            pixel_events: pixel_events.transpose()?,
            clocks,
            sinks,
            totals: RunTotals::default(),
            reserve: Some(SpaceReserve::new(
                folder,
                ".reserve",
                MIN_RESERVE_BYTES + owed_bytes + owed_by_clocks,
            )),
            video_reserve,
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
        self.write_out(false)?;
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

    /// Writes the buffered data if there is much of it, or in any case with `all`. On a full disk
    /// the data stays in memory, and every file has the same frames.
    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.table.write_out(all)?;
        self.pixel_events.as_mut().map_or(Ok(()), |pixels| pixels.write_out(all))?;
        self.clocks.as_mut().map_or(Ok(()), |clocks| clocks.write_out(all))?;
        self.sinks.iter_mut().try_for_each(|sink| sink.write_out(all))
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
        if let Err(error) = self.write_out(true)
            && !may_leave_out(&error)
        {
            return Err(error);
        }
        // Files that another program writes are completed first. That program would otherwise use
        // the space that is released for the other files.
        drop(self.video_reserve.take());
        let (videos, sinks): (Vec<_>, Vec<_>) = std::mem::take(&mut self.sinks)
            .into_iter()
            .partition(|sink| sink.is_written_by_other_program());
        finish_expendable(videos, &may_leave_out, &mut problem)?;
        drop(self.reserve.take());
        let (expendable, needed) =
            sinks.into_iter().partition::<Vec<_>, _>(|sink| sink.expendable_path().is_some());
        self.sinks = needed;
        let expendable = self.make_room(expendable, &mut problem)?;
        for sink in std::mem::take(&mut self.sinks) {
            sink.finish()?;
        }
        let pixel_events = self.pixel_events.take().map(PixelEventFiles::finish).transpose()?;
        let clocks = self.clocks.take().map(ClockFiles::finish).transpose()?;
        let (clocks, clock_table) = clocks.map_or((None, None), |(own, table)| (Some(own), table));
        let summary = |problem| {
            let mut summary = self.totals.summary(&self.design, inputs, problem, pixel_events);
            summary.data_set.clone_from(&self.data_set);
            summary.clocks = clocks;
            summary.luma = luma.map(LumaRange::name);
            summary.write(&folder.join("summary.json")).map(|()| summary)
        };
        // The summary is written while there is space, before the last outputs are completed.
        let written = summary(problem.clone())?;
        finish_expendable(expendable, &may_leave_out, &mut problem)?;
        if let Some(table) = clock_table {
            check_finished(Some(table.path()), table.finish(), &may_leave_out, &mut problem)?;
        }
        if written.problem == problem { Ok(written) } else { summary(problem) }
    }

    /// Writes all needed outputs. Gives up one expendable output after the other until there is
    /// enough space. Returns the expendable outputs that remain.
    fn make_room(
        &mut self,
        mut expendable: Vec<Box<dyn FrameSink>>,
        problem: &mut Option<String>,
    ) -> Result<Vec<Box<dyn FrameSink>>, SimulatorError> {
        loop {
            let Err(error) = self.write_out(true) else { return Ok(expendable) };
            if !error.is_full() {
                return Err(error);
            }
            let clock_table = self.clocks.as_mut().and_then(ClockFiles::give_up_parquet);
            // The file is closed when its sink is dropped.
            let path =
                clock_table.or_else(|| expendable.pop().and_then(|own| own.expendable_path()));
            let Some(path) = path else { return Err(error) };
            leave_out(&path, problem);
        }
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

/// Completes outputs. An expendable output that fails is given up.
fn finish_expendable(
    sinks: Vec<Box<dyn FrameSink>>,
    may_leave_out: &dyn Fn(&SimulatorError) -> bool,
    problem: &mut Option<String>,
) -> Result<(), SimulatorError> {
    for sink in sinks {
        check_finished(sink.expendable_path(), sink.finish(), may_leave_out, problem)?;
    }
    Ok(())
}

/// Checks that an output is complete. An expendable output, which has a path, is given up if it
/// failed.
fn check_finished(
    expendable: Option<PathBuf>,
    finished: Result<(), SimulatorError>,
    may_leave_out: &dyn Fn(&SimulatorError) -> bool,
    problem: &mut Option<String>,
) -> Result<(), SimulatorError> {
    match (expendable, finished) {
        (Some(path), Err(error)) if may_leave_out(&error) => {
            leave_out(&path, problem);
            Ok(())
        }
        (_, finished) => finished,
    }
}

/// Removes a file or a folder of pictures that cannot be completed, and names it in the problem of
/// the run.
fn leave_out(path: &Path, problem: &mut Option<String>) {
    // The path lies in the folder of this run. If it cannot be removed, the summary still names it.
    let _ = std::fs::remove_file(path).or_else(|_| std::fs::remove_dir_all(path));
    let name = path.file_name().expect("an output has a name").display();
    let left_out = format!("{name} is left out");
    *problem = Some(match problem.take() {
        Some(problem) => format!("{problem}; {left_out}"),
        None => format!("{DISK_FULL}; {left_out}"),
    });
}

fn count_set(bits: &[bool]) -> u64 {
    bits.iter().map(|&bit| u64::from(bit)).sum()
}
