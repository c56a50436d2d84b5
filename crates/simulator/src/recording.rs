// SPDX-License-Identifier: MIT OR Apache-2.0
//! The conversion of a recorded stream of packets to the files of a simulation. The same writers
//! write the same files, as far as the stream has their content. Missing data is listed in
//! `losses.csv`, and the summary says that the run is not complete.

use std::io::{ErrorKind, Read};
use std::path::Path;

use foveate_design::{Design, DesignConfig};
use foveate_media::{PlaybackError, RunHooks, RunProgress, SetForm, SourceFrame};
use foveate_packets::{PacketError, StreamLoss};
use foveate_tools::{Interrupt, StagedFolder};

use super::losses::LossTable;
use crate::output::{FrameContent, INTERRUPTED, RunRecorder};
use crate::simulation::{SIMULATION_FOLDER, disk_full_problem};
use crate::stream::{PacketStream, ShownFrame, StreamItem};
use crate::{RunOptions, RunSummary, SimulatorError};

/// The number of bytes that are read at once.
const CHUNK: usize = 1 << 16;

/// A stream of packets, and the configuration of the camera that sent it.
pub struct PacketRecording<'a> {
    /// The configuration. It may leave the frame size open.
    pub config: &'a DesignConfig,
    /// The bytes of the stream.
    pub stream: &'a mut dyn Read,
    /// The name of the stream in messages.
    pub name: &'a str,
}

/// The result of reading a stream.
#[derive(Clone, Debug)]
pub struct DecodedRecording {
    /// The summary, as of a simulation.
    pub summary: RunSummary,
    /// The first losses.
    pub losses: Vec<StreamLoss>,
    /// The number of all losses, which are listed in `losses.csv`.
    pub loss_count: u64,
}

impl PacketRecording<'_> {
    /// Reads to the end of the stream, or until `hooks` cancels, and writes the folder `output` as
    /// [`Simulation::run`](crate::Simulation::run) does.
    ///
    /// # Errors
    /// Fails if the stream is not one of this camera, or if the output cannot be written. Damage of
    /// the stream is not an error.
    pub fn decode(
        self,
        output: &Path,
        options: &RunOptions,
        hooks: &dyn RunHooks,
    ) -> Result<DecodedRecording, SimulatorError> {
        check_outputs(options)?;
        let staging = StagedFolder::new(output, SIMULATION_FOLDER, options.overwrite)?;
        let decoded = self.write(staging.folder(), options, hooks);
        let decoded = decoded.map_err(|error| error.with_shown_paths(&staging))?;
        staging.commit()?;
        Ok(decoded)
    }

    fn write(
        self,
        folder: &Path,
        options: &RunOptions,
        hooks: &dyn RunHooks,
    ) -> Result<DecodedRecording, SimulatorError> {
        let mut writer = RecordingWriter {
            folder,
            options,
            interrupt: hooks.interrupt(),
            losses: LossTable::new(folder),
            recorder: None,
        };
        let (mut stream, mut chunk, mut bytes) =
            (PacketStream::new(self.config), vec![0; CHUNK], 0u64);
        let (mut is_cancelled, mut is_full) = (false, None);
        loop {
            let read = match self.stream.read(&mut chunk) {
                // The system asks to try again, or the user stopped the run during the wait.
                Err(source) if source.kind() == ErrorKind::Interrupted || hooks.is_cancelled() => {
                    None
                }
                Err(source) => {
                    return Err(SimulatorError::ReadStream {
                        stream: self.name.to_owned(),
                        source,
                    });
                }
                Ok(read) => Some(read),
            };
            is_cancelled |= hooks.is_cancelled();
            let ends = is_cancelled || read == Some(0);
            if ends {
                stream.complete();
            } else if let Some(read) = read {
                bytes += read as u64;
                stream.feed(&chunk[..read]);
            }
            // A few bytes may cause much work, so the run can be stopped between two frames, too.
            let is_all =
                match (writer.write_received(&mut stream, hooks, is_cancelled), writer.frames()) {
                    (Err(error), 1..) if error.is_full() => {
                        is_full = Some(disk_full_problem(&error, writer.frames(), folder));
                        break;
                    }
                    (other, _) => other?,
                };
            is_cancelled |= !is_all;
            if ends || !is_all {
                break;
            }
        }
        let RecordingWriter { losses, recorder, .. } = writer;
        let Some(recorder) = recorder else {
            let none = PacketError::NoFrame { stream: self.name.to_owned(), bytes };
            return Err(if is_cancelled { PlaybackError::Interrupted.into() } else { none.into() });
        };
        let problem = match (is_cancelled, losses.count()) {
            _ if is_full.is_some() => is_full,
            (true, _) => Some(INTERRUPTED.to_owned()),
            (false, 0) => None,
            (false, 1) => Some("1 loss in the stream, in losses.csv".to_owned()),
            (false, count) => Some(format!("{count} losses in the stream, in losses.csv")),
        };
        let summary = recorder.finish(folder, (&[self.name.to_owned()], None), problem)?;
        let (losses, loss_count) = losses.finish()?;
        Ok(DecodedRecording { summary, losses, loss_count })
    }
}

/// Refuses outputs that cannot be made from any stream.
fn check_outputs(options: &RunOptions) -> Result<(), SimulatorError> {
    let impossible = [
        (
            options.pixel_events.is_wanted(),
            "pixel events",
            "they are made of frames before the camera",
        ),
        (options.clocks.is_wanted(), "clocks", "they are computed from frames before the camera"),
        (options.data_set, "data set", "it is made of frames before the camera"),
        (options.packets.is_some(), "packets", "it has them already"),
    ];
    match impossible.into_iter().find(|(wanted, _, _)| *wanted) {
        None => Ok(()),
        Some((_, output, why)) => Err(SimulatorError::NotInStream { output, why }),
    }
}

/// The files of a stream. The recorder is created when the first frame arrives.
struct RecordingWriter<'a> {
    folder: &'a Path,
    options: &'a RunOptions,
    interrupt: Interrupt,
    losses: LossTable,
    recorder: Option<RunRecorder>,
}

impl RecordingWriter<'_> {
    /// Returns the number of frames so far.
    fn frames(&self) -> u64 {
        self.recorder.as_ref().map_or(0, RunRecorder::frames)
    }

    /// Writes all frames that are available. Stops early when `hooks` cancels, unless
    /// `is_cancelled` is set already. Returns true if all were written.
    fn write_received(
        &mut self,
        stream: &mut PacketStream,
        hooks: &dyn RunHooks,
        is_cancelled: bool,
    ) -> Result<bool, SimulatorError> {
        loop {
            let Some(received) = stream.receive_past_foreign()? else { return Ok(true) };
            match received {
                StreamItem::Loss(loss) => self.losses.push(loss)?,
                StreamItem::Register(_) => {}
                StreamItem::Frame(frame) => {
                    if let Some(design) = stream.design() {
                        self.write_frame(*frame, design, stream.has_scores())?;
                    }
                    hooks.progress(&RunProgress::frames(self.frames(), None, ""));
                    if !is_cancelled && hooks.is_cancelled() {
                        return Ok(false);
                    }
                }
            }
        }
    }

    /// Writes a frame if its time is known. A simulation draws an overlay over the frame that the
    /// camera gets; here it is drawn over the screen.
    fn write_frame(
        &mut self,
        frame: ShownFrame,
        design: &Design,
        has_scores: bool,
    ) -> Result<(), SimulatorError> {
        let Some(time_us) = frame.time_us else { return Ok(()) };
        let recorder = match &mut self.recorder {
            Some(recorder) => recorder,
            none => {
                if self.options.heatmap.is_some() && !has_scores {
                    let why = "it was sent without scores; leave --heatmap out";
                    return Err(SimulatorError::NotInStream { output: "heat maps", why });
                }
                let form = SetForm::default();
                let has_map_versions = design.zones().is_some();
                let created = RunRecorder::create(
                    self.folder,
                    design,
                    &form,
                    self.options,
                    FrameContent { has_scores, has_map_versions },
                    &self.interrupt,
                )?;
                none.insert(created)
            }
        };
        let ShownFrame { number, map_version, screen: frame, outcome, .. } = frame;
        let source = SourceFrame { name: number.to_string(), time_us, label: None, frame };
        let screen = source.frame.borrowed_pixels();
        recorder.push_received(&source, map_version, &outcome, (design, screen))
    }
}
