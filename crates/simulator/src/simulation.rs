// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run: every frame of a source goes through one camera, into one folder.

use std::path::Path;

use foveate_design::{Design, DesignConfig};
use foveate_engine::Engine;
use foveate_staging::{FolderKind, StagedFolder};

use crate::output::{DISK_FULL, INTERRUPTED, RunRecorder};
use crate::{RunOptions, RunSummary, SimulatorError};
use foveate_footage::{FootageError, FrameSource, RunHooks, RunProgress, SourceKind, read_ahead};

/// A design and the frames that it takes.
pub struct Simulation {
    design: Design,
    source: Box<dyn FrameSource>,
}

impl Simulation {
    /// Fits the configuration to the frame size of the source.
    ///
    /// # Errors
    /// Fails if the configuration gives another size, or is not a valid design.
    pub fn new(
        config: &DesignConfig,
        source: Box<dyn FrameSource>,
    ) -> Result<Self, SimulatorError> {
        let (width, height) = source.size();
        Ok(Self { design: config.validate_for_frames(width, height)?, source })
    }

    /// Returns the design, with the frame size of the source.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Runs to the end of the source, or until `hooks` cancels. The folder `output` appears when
    /// everything is written. An error leaves no folder. The results so far are kept, with
    /// `complete: false` in the summary, if the source ends early (such as a truncated video), on
    /// an interrupt, and if the disk is full.
    ///
    /// # Errors
    /// Fails if a frame cannot be read, the output cannot be written, or there is no frame.
    pub fn run(
        mut self,
        output: &Path,
        options: &RunOptions,
        hooks: &mut dyn RunHooks,
    ) -> Result<RunSummary, SimulatorError> {
        if options.pixel_events.is_wanted() && self.source.kind() == SourceKind::Set {
            return Err(SimulatorError::PixelEventsOfSet);
        }
        if options.data_set && self.source.kind() == SourceKind::Clip {
            return Err(SimulatorError::NotASet { inputs: self.source.inputs().join(", ") });
        }
        let staging = StagedFolder::new(output, SIMULATION_FOLDER, options.overwrite)?;
        let written = self.write_files(&staging, options, hooks);
        let summary = written.map_err(|error| error.with_shown_paths(&staging))?;
        staging.commit()?;
        Ok(summary)
    }

    /// Writes all files.
    fn write_files(
        &mut self,
        staging: &StagedFolder,
        options: &RunOptions,
        hooks: &mut dyn RunHooks,
    ) -> Result<RunSummary, SimulatorError> {
        let folder = staging.folder();
        let mut recorder = RunRecorder::create(
            folder,
            &self.design,
            &self.source.form(),
            options,
            true,
            &hooks.interrupt(),
        )?;
        let end = match self.run_frames(&mut recorder, hooks) {
            // The interrupt ended the wait for a frame.
            Err(SimulatorError::Cancelled) => Ok(RunEnd::Cancelled),
            end => end,
        };
        let problem = match (end, recorder.frames()) {
            (Ok(RunEnd::Cancelled), 0) => return Err(SimulatorError::Cancelled),
            (Ok(RunEnd::EndOfSource), 0) => {
                let inputs = self.source.inputs().join(", ");
                return Err(FootageError::NoFrames { inputs }.into());
            }
            (Ok(RunEnd::Cancelled), _) => Some(INTERRUPTED.to_owned()),
            // An interrupt may have stopped ffmpeg, too.
            (Ok(RunEnd::EndOfSource), _) => self
                .source
                .problem()
                .map(|problem| if hooks.is_cancelled() { INTERRUPTED.to_owned() } else { problem }),
            (Err(SimulatorError::VideoOutput { .. }), 1..) if hooks.is_cancelled() => {
                Some(INTERRUPTED.to_owned())
            }
            (Err(error), 1..) if error.is_full() => {
                Some(disk_full_problem(&error, recorder.frames(), folder))
            }
            (Err(error), _) => return Err(error),
        };
        recorder.finish(folder, self.source.inputs(), problem)
    }

    /// Gives every frame to the engine, while the following frames are read.
    fn run_frames(
        &mut self,
        recorder: &mut RunRecorder,
        hooks: &mut dyn RunHooks,
    ) -> Result<RunEnd, SimulatorError> {
        let mut engine = Engine::new(&self.design);
        let (total, kind) = (self.source.frames(), self.source.kind());
        read_ahead(self.source.as_mut(), |frames| {
            while let Some((current, _)) = frames.next()? {
                if hooks.is_cancelled() {
                    return Ok(RunEnd::Cancelled);
                }
                if kind == SourceKind::Set {
                    engine.reset();
                }
                engine.step_byte_frame(&current.frame)?;
                let first = kind == SourceKind::Set || recorder.frames() == 0;
                recorder.push(&current, &engine, first)?;
                frames.recycle(current);
                hooks.progress(RunProgress { done: recorder.frames(), total });
            }
            Ok(RunEnd::EndOfSource)
        })
    }
}

/// The reason why no more frames come.
enum RunEnd {
    EndOfSource,
    Cancelled,
}

/// Returns the problem in the summary of a run that found no disk space for one of its files in
/// `folder`.
pub(crate) fn disk_full_problem(error: &SimulatorError, frames: u64, folder: &Path) -> String {
    let file = error.unwritten_path().map(|path| path.strip_prefix(folder).unwrap_or(path));
    let at = file.map(|file| format!(", at {}", file.display())).unwrap_or_default();
    format!("{DISK_FULL} after {frames} frames{at}")
}

impl std::fmt::Debug for Simulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Simulation").field("design", &self.design).finish_non_exhaustive()
    }
}

/// The kind of folder that a run leaves, and the only kind that it replaces.
pub const SIMULATION_FOLDER: FolderKind =
    FolderKind { description: "a simulation (its summary.json)", matches: is_simulation };

fn is_simulation(folder: &Path) -> bool {
    let summary = std::fs::read(folder.join("summary.json")).unwrap_or_default();
    serde_json::from_slice::<serde_json::Value>(&summary)
        .is_ok_and(|value| value.get("foveate_version").is_some())
}
