// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run: every frame of a source goes through one camera, into one folder.

use std::path::Path;

use foveate_design::{Design, DesignConfig};
use foveate_engine::Engine;
use foveate_media::{ClipPlayer, PlaybackError, RunHooks, RunMonitor, SourceKind};
use foveate_tools::{FolderKind, StagedFolder};

use crate::output::{DISK_FULL, FrameContent, INTERRUPTED, RunRecorder};
use crate::{RunOptions, RunSummary, SimulatorError};

/// A design and the frames that it takes.
pub struct Simulation {
    design: Design,
    player: ClipPlayer,
}

impl Simulation {
    /// Fits the configuration to the frame size of the clip.
    ///
    /// # Errors
    /// Fails if the configuration gives another size, or is not a valid design.
    pub fn new(
        config: &DesignConfig,
        player: impl Into<ClipPlayer>,
    ) -> Result<Self, SimulatorError> {
        let player = player.into();
        let (width, height) = player.size();
        Ok(Self { design: config.validate_for_frames(width, height)?, player })
    }

    /// Returns the design, with the frame size of the clip.
    #[must_use]
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Runs to the end of the clip, or until `hooks` cancels. The folder `output` appears when
    /// everything is written. An error leaves no folder. The results so far are kept, with
    /// `complete: false` in the summary, if the clip ends early (such as a truncated video), on
    /// an interrupt, and if the disk is full.
    ///
    /// # Errors
    /// Fails if a frame cannot be read, the output cannot be written, or there is no frame.
    pub fn run(
        mut self,
        output: &Path,
        options: &RunOptions,
        hooks: &dyn RunHooks,
    ) -> Result<RunSummary, SimulatorError> {
        if options.pixel_events.is_wanted() && self.player.kind() == SourceKind::Set {
            return Err(SimulatorError::PixelEventsOfSet);
        }
        if options.clocks.is_wanted() && self.player.kind() == SourceKind::Set {
            return Err(SimulatorError::ClocksOfSet);
        }
        if options.data_set && self.player.kind() == SourceKind::Clip {
            return Err(SimulatorError::NotASet { inputs: self.player.inputs().join(", ") });
        }
        let staging = StagedFolder::new(output, SIMULATION_FOLDER, options.overwrite)?;
        let written = self.write_files(&staging, options, hooks);
        let summary = written.map_err(|error| error.with_shown_paths(&staging))?;
        staging.commit()?;
        Ok(summary)
    }

    fn write_files(
        &mut self,
        staging: &StagedFolder,
        options: &RunOptions,
        hooks: &dyn RunHooks,
    ) -> Result<RunSummary, SimulatorError> {
        let folder = staging.folder();
        // The map of classes does not change, so that no table has its version.
        let content = FrameContent { has_scores: true, has_map_versions: false };
        let mut recorder = RunRecorder::create(
            folder,
            &self.design,
            self.player.form(),
            options,
            content,
            &hooks.interrupt(),
        )?;
        let problem = match (self.run_frames(&mut recorder, hooks), recorder.frames()) {
            (Ok(()), _) => self.player.problem().map(str::to_owned),
            (Err(SimulatorError::Playback(PlaybackError::Interrupted)), 1..) => {
                Some(INTERRUPTED.to_owned())
            }
            (Err(SimulatorError::VideoOutput { .. }), 1..) if hooks.is_cancelled() => {
                Some(INTERRUPTED.to_owned())
            }
            (Err(error), 1..) if error.is_full() => {
                Some(disk_full_problem(&error, recorder.frames(), folder))
            }
            (Err(error), _) => return Err(error),
        };
        recorder.finish(folder, (self.player.inputs(), self.player.luma()), problem)
    }

    /// Shows every frame to the engine.
    fn run_frames(
        &mut self,
        recorder: &mut RunRecorder,
        hooks: &dyn RunHooks,
    ) -> Result<(), SimulatorError> {
        let mut engine = Engine::new(&self.design);
        let monitor = RunMonitor::of_frames(hooks, self.player.frames());
        for frame in monitor.watch(&mut self.player) {
            let frame = frame?;
            frame.show_to(&mut engine)?;
            recorder.push(&frame, &engine, frame.is_first())?;
        }
        Ok(())
    }
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
