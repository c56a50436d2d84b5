// SPDX-License-Identifier: MIT OR Apache-2.0
//! Many clips in one run: one output folder per clip, in a tree like that of the inputs, and one
//! summary of the batch. If a clip fails, the others are still completed.

mod summary;

pub use summary::{BatchSummary, ClipSummary};

use std::path::Path;

use foveate_design::DesignConfig;
use foveate_media::{
    BatchClip, ClipPlayer, InputOptions, PlaybackError, RunHooks, RunMonitor, RunProgress,
    run_in_parallel,
};
use foveate_tools::{Interrupt, StagedFolder};

use crate::output::INTERRUPTED;
use crate::simulation::SIMULATION_FOLDER;
use crate::{RunOptions, RunSummary, Simulation, SimulatorError};

/// Runs every clip into a folder below `output`, with as many clips in parallel as rayon has
/// threads. The folder `output` appears at the end.
///
/// # Errors
/// Fails if the output cannot be written, or if no clip could be simulated.
pub fn run_batch(
    clips: &[BatchClip],
    config: &DesignConfig,
    input: &InputOptions,
    output: &Path,
    options: &RunOptions,
    hooks: &dyn RunHooks,
) -> Result<BatchSummary, SimulatorError> {
    let staging = StagedFolder::new(output, SIMULATION_FOLDER, options.overwrite)?;
    let monitor = RunMonitor::of_clips(hooks, clips.len());
    let batch = BatchRun { clips, config, input, options, monitor, staging: &staging };
    let summary = batch.run()?;
    let text = serde_json::to_string_pretty(&summary).expect("plain data with text keys") + "\n";
    staging.write("summary.json", text.as_bytes())?;
    staging.commit()?;
    Ok(summary)
}

/// The state of a running batch.
struct BatchRun<'a> {
    clips: &'a [BatchClip],
    config: &'a DesignConfig,
    input: &'a InputOptions,
    options: &'a RunOptions,
    monitor: RunMonitor<'a>,
    staging: &'a StagedFolder,
}

impl BatchRun<'_> {
    fn run(&self) -> Result<BatchSummary, SimulatorError> {
        let results = run_in_parallel(self.clips.len(), |number| {
            (!self.monitor.is_cancelled()).then(|| self.clip_summary(&self.clips[number]))
        });
        let not_started = |clip| ClipSummary::of_failed_clip(clip, "not started".to_owned());
        let clips = results.into_iter().zip(self.clips);
        let clips = clips.map(|(result, clip)| result.unwrap_or_else(|| not_started(clip)));
        self.batch_summary(clips.collect())
    }

    fn clip_summary(&self, clip: &BatchClip) -> ClipSummary {
        let summary = match self.simulate(clip) {
            Ok(summary) => ClipSummary::of_finished_clip(clip, summary),
            Err(SimulatorError::Playback(PlaybackError::Interrupted)) => {
                ClipSummary::of_failed_clip(clip, INTERRUPTED.to_owned())
            }
            Err(error) => ClipSummary::of_failed_clip(clip, error.to_string()),
        };
        self.monitor.add_clip();
        summary
    }

    fn simulate(&self, clip: &BatchClip) -> Result<RunSummary, SimulatorError> {
        let player = ClipPlayer::open(&clip.inputs, &self.config.camera, self.input)?;
        let output = self.staging.folder().join(&clip.output_folder);
        let simulation = Simulation::new(self.config, player)?;
        let done = simulation.run(&output, self.options, &ClipHooks(self));
        done.map_err(|error| error.with_shown_paths(self.staging))
    }

    fn batch_summary(&self, clips: Vec<ClipSummary>) -> Result<BatchSummary, SimulatorError> {
        let partial = clips.iter().filter(|clip| !clip.complete).count();
        if clips.iter().all(|clip| clip.output.is_none()) {
            if self.monitor.is_cancelled() {
                return Err(PlaybackError::Interrupted.into());
            }
            let first = clips.iter().find_map(|clip| clip.problem.clone()).unwrap_or_default();
            return Err(SimulatorError::NoClip { clips: clips.len(), first });
        }
        let problem = match (self.monitor.is_cancelled(), partial) {
            (_, 0) => None,
            (true, _) => Some(INTERRUPTED.to_owned()),
            (false, some) => Some(format!("{some} of {} clips are not complete", clips.len())),
        };
        Ok(BatchSummary {
            format_version: summary::FORMAT_VERSION,
            foveate_version: env!("CARGO_PKG_VERSION"),
            complete: problem.is_none(),
            problem,
            frames: clips.iter().map(|clip| clip.frames).sum(),
            clips,
        })
    }
}

/// The hooks of one clip, which count its frames into the batch.
struct ClipHooks<'a>(&'a BatchRun<'a>);

impl RunHooks for ClipHooks<'_> {
    fn progress(&self, _: &RunProgress<'_>) {
        self.0.monitor.add_frame();
    }

    fn is_cancelled(&self) -> bool {
        self.0.monitor.is_cancelled()
    }

    fn interrupt(&self) -> Interrupt {
        self.0.input.interrupt.clone()
    }
}
