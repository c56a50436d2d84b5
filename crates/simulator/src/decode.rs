// SPDX-License-Identifier: MIT OR Apache-2.0
//! A recorded stream of packets, written as a simulation is: the same files by the same writers, as far as the stream
//! says what is in them. What is missing is listed in `losses.csv`, and the summary says that the run is not complete.

use std::io::{ErrorKind, Read};
use std::path::Path;

use foveate_design::{Config, Design};
use foveate_engine::{FrameOutcome, Receiver};
use foveate_footage::{SetForm, SourceFrame};
use foveate_frame::{Plane, Raster};
use foveate_packets::{
    Assembler, Content, Found, FrameInfo, Layout, Loss, Packet, PacketError, ReceivedFrame,
    Splitter,
};
use foveate_staging::StagedFolder;

use crate::losses::Losses;
use crate::output::{INTERRUPTED, Recorder};
use crate::simulation::SIMULATION;
use crate::{Hooks, Progress, RunOptions, SimulatorError, Summary};

/// Bytes that are read at once.
const CHUNK: usize = 1 << 16;

/// A stream of packets, and the configuration of the camera that sent it.
pub struct Recording<'a> {
    /// The configuration, of which the frame size may be missing.
    pub config: &'a Config,
    /// The bytes.
    pub stream: &'a mut dyn Read,
    /// What they are called.
    pub name: &'a str,
}

/// What came of a stream.
#[derive(Clone, Debug)]
pub struct Decoded {
    /// As of a simulation.
    pub summary: Summary,
    /// The first losses.
    pub losses: Vec<Loss>,
    /// How many there are; all are in `losses.csv`.
    pub loss_count: u64,
}

impl Recording<'_> {
    /// Reads to the end of the stream, or until `hooks` cancels, and writes the folder `output` as
    /// [`Simulation::run`](crate::Simulation::run) does.
    ///
    /// # Errors
    /// When the stream is none of this camera, or the output cannot be written. Damage is no error.
    pub fn decode(
        self,
        output: &Path,
        options: &RunOptions,
        hooks: &mut dyn Hooks,
    ) -> Result<Decoded, SimulatorError> {
        possible(options)?;
        let staging = StagedFolder::new(output, SIMULATION, options.overwrite)?;
        let mut reader = Reader {
            config: self.config,
            folder: staging.folder(),
            options,
            losses: Losses::new(staging.folder()),
            run: None,
        };
        let (mut splitter, mut chunk, mut bytes) = (Splitter::default(), vec![0; CHUNK], 0u64);
        let mut is_cancelled = false;
        loop {
            let read = match self.stream.read(&mut chunk) {
                // The system asks to try again, perhaps because the user stops the run.
                Err(source) if source.kind() == ErrorKind::Interrupted => None,
                Err(source) => {
                    return Err(SimulatorError::ReadStream {
                        stream: self.name.to_owned(),
                        source,
                    });
                }
                Ok(read) => Some(read),
            };
            is_cancelled |= hooks.cancelled();
            let ends = is_cancelled || read == Some(0);
            if ends {
                splitter.complete();
            } else if let Some(read) = read {
                bytes += read as u64;
                splitter.feed(&chunk[..read]);
            }
            reader.take(&mut splitter, hooks)?;
            if ends {
                break;
            }
        }
        let Some(run) = reader.run else {
            let none = PacketError::NoFrame { stream: self.name.to_owned(), bytes };
            return Err(if is_cancelled { SimulatorError::Cancelled } else { none.into() });
        };
        let mut losses = reader.losses;
        let recorder = run.end(&mut losses)?;
        if recorder.frames() == 0 {
            return Err(PacketError::NoFrame { stream: self.name.to_owned(), bytes }.into());
        }
        let problem = match (is_cancelled, losses.count()) {
            (true, _) => Some(INTERRUPTED.to_owned()),
            (false, 0) => None,
            (false, 1) => Some("1 loss in the stream, in losses.csv".to_owned()),
            (false, count) => Some(format!("{count} losses in the stream, in losses.csv")),
        };
        let summary = recorder.finish(staging.folder(), &[self.name.to_owned()], problem)?;
        let (losses, loss_count) = losses.finish()?;
        staging.commit()?;
        Ok(Decoded { summary, losses, loss_count })
    }
}

/// Refuses what cannot be made of any stream.
fn possible(options: &RunOptions) -> Result<(), SimulatorError> {
    let impossible = [
        (
            options.pixel_events.wanted(),
            "pixel events",
            "they are made of frames before the camera",
        ),
        (options.data_set, "data set", "it is made of frames before the camera"),
        (options.packets.is_some(), "packets", "it has them already"),
    ];
    match impossible.into_iter().find(|(wanted, _, _)| *wanted) {
        None => Ok(()),
        Some((_, output, why)) => Err(SimulatorError::NotInStream { output, why }),
    }
}

/// Waits for the first FRAME, which says what frames there are.
struct Reader<'a> {
    config: &'a Config,
    folder: &'a Path,
    options: &'a RunOptions,
    losses: Losses,
    run: Option<Run>,
}

impl Reader<'_> {
    /// Takes all packets that are there.
    fn take(
        &mut self,
        splitter: &mut Splitter,
        hooks: &mut dyn Hooks,
    ) -> Result<(), SimulatorError> {
        loop {
            match splitter.next(self.run.as_ref().map(|run| run.assembler.layout())) {
                Found::Nothing => return Ok(()),
                Found::Skipped { offset, bytes } => {
                    self.losses.push(Loss::Bytes { offset, bytes })?;
                }
                Found::Packet { frame, packet } => {
                    if let (None, Packet::Frame(info)) = (&self.run, &packet) {
                        self.run = Some(self.begin(frame, info)?);
                    }
                    if let Some(run) = &mut self.run {
                        run.take(frame, packet, &mut self.losses)?;
                        hooks.progress(Progress { done: run.recorder.frames(), total: None });
                    }
                }
            }
        }
    }

    /// The run of a stream whose first FRAME says this.
    fn begin(&self, frame: u32, info: &FrameInfo) -> Result<Run, SimulatorError> {
        if info.version != foveate_packets::VERSION {
            return Err(PacketError::Version { frame, version: info.version }.into());
        }
        let design = self.config.for_frames(info.width.into(), info.height.into())?;
        if self.options.heatmap.is_some() && !info.has_scores {
            let why = "it was sent without scores; leave --heatmap out";
            return Err(SimulatorError::NotInStream { output: "heat maps", why });
        }
        let layout = Layout::new(&design, info.has_scores, info.ticks_per_second);
        // Before anything is written: the design may be another.
        let assembler = Assembler::new(layout);
        assembler.check(frame, info)?;
        let form = SetForm::default();
        let recorder =
            Recorder::create(self.folder, &design, &form, self.options, info.has_scores)?;
        Ok(Run { receiver: Receiver::new(&design), assembler, recorder, design, start: None })
    }
}

/// Frames on their way from packets to files.
struct Run {
    design: Design,
    assembler: Assembler,
    receiver: Receiver,
    recorder: Recorder,
    /// When the first frame began, in ticks.
    start: Option<u64>,
}

impl Run {
    fn take(
        &mut self,
        frame: u32,
        packet: Packet,
        losses: &mut Losses,
    ) -> Result<(), SimulatorError> {
        let ended = self.assembler.push(frame, packet)?;
        self.assembler.losses().into_iter().try_for_each(|loss| losses.push(loss))?;
        ended.into_iter().flatten().try_for_each(|frame| self.show(frame))
    }

    /// Ends with the stream.
    fn end(mut self, losses: &mut Losses) -> Result<Recorder, SimulatorError> {
        let last = self.assembler.end();
        self.assembler.losses().into_iter().try_for_each(|loss| losses.push(loss))?;
        last.into_iter().try_for_each(|frame| self.show(frame))?;
        Ok(self.recorder)
    }

    /// Shows a frame, and writes it if its time is known.
    fn show(&mut self, frame: ReceivedFrame) -> Result<(), SimulatorError> {
        if frame.info.as_ref().is_some_and(|info| info.first) {
            self.receiver.reset();
        }
        for (region, content) in (0..).zip(&frame.contents) {
            match content {
                Some(Content::Pixels(pixels)) => self.receiver.take_pixels(region, pixels),
                Some(Content::Means(means)) => self.receiver.take_means(region, means),
                None => {}
            }
        }
        let actions = frame.actions(self.design.irrelevant());
        self.receiver.show(&actions);
        let Some(info) = &frame.info else { return Ok(()) };
        let start = *self.start.get_or_insert(info.time);
        let ticks = u128::from(info.time.saturating_sub(start));
        let time_us = ticks * 1_000_000 / u128::from(info.ticks_per_second.max(1));
        let screen = self.receiver.rendered();
        let source = SourceFrame {
            name: frame.number.to_string(),
            time_us: u64::try_from(time_us).unwrap_or(u64::MAX),
            label: None,
            frame: raster(&self.design, screen)?,
        };
        let of = |bit: fn(&foveate_packets::Decision) -> bool| {
            frame.decisions.iter().map(bit).collect::<Vec<_>>()
        };
        let outcome = FrameOutcome {
            srs: of(|decision| decision.srs),
            trs: of(|decision| decision.trs),
            active: of(|decision| decision.srs && decision.trs),
            actions,
            temporal_count: frame.temporal_count,
            scores: frame.scores,
            skipped: 0,
        };
        self.recorder.push_received(&source, &outcome, (&self.design, screen))
    }
}

/// A copy of the screen. What is drawn over the frame before the camera in a simulation is drawn over this.
fn raster(design: &Design, screen: Plane<'_>) -> Result<Raster, SimulatorError> {
    let (width, height, bits) = (design.width(), design.height(), design.pixel_bits());
    Ok(match screen {
        Plane::Bytes(pixels) => Raster::from_bytes(width, height, bits, pixels.to_vec())?,
        Plane::Words(pixels) => Raster::from_words(width, height, bits, pixels.to_vec())?,
    })
}
