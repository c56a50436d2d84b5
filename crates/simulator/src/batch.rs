// SPDX-License-Identifier: MIT OR Apache-2.0
//! Many clips in one run: one output folder per clip, in a tree like that of the inputs, and one
//! summary of the batch. If a clip fails, the others are still completed.

mod summary;

pub use summary::{BatchSummary, ClipSummary};

use std::path::Path;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use foveate_design::DesignConfig;
use foveate_staging::StagedFolder;
use foveate_toolchain::Interrupt;

use crate::output::INTERRUPTED;
use crate::simulation::SIMULATION_FOLDER;
use crate::{RunHooks, RunOptions, RunProgress, RunSummary, Simulation, SimulatorError};
use foveate_footage::{BatchClip, InputOptions, open};

/// The progress of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BatchProgress {
    /// The number of clips that are done or have failed.
    pub clips: usize,
    /// The number of all clips.
    pub total_clips: usize,
    /// The number of frames of all clips so far.
    pub frames: u64,
}

/// The callbacks of a batch. Several threads call them.
pub trait BatchHooks: Sync {
    /// Reports that another frame or clip is done.
    fn progress(&self, progress: BatchProgress);

    /// Returns true if the batch is to stop. The result is then incomplete, and is marked so.
    fn is_cancelled(&self) -> bool;
}

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
    hooks: &dyn BatchHooks,
) -> Result<BatchSummary, SimulatorError> {
    let staging = StagedFolder::new(output, SIMULATION_FOLDER, options.overwrite)?;
    let batch = BatchRun {
        clips,
        config,
        input,
        options,
        hooks,
        staging: &staging,
        next: AtomicUsize::new(0),
        done: AtomicUsize::new(0),
        frames: AtomicU64::new(0),
    };
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
    hooks: &'a dyn BatchHooks,
    staging: &'a StagedFolder,
    next: AtomicUsize,
    done: AtomicUsize,
    frames: AtomicU64,
}

impl BatchRun<'_> {
    fn run(&self) -> Result<BatchSummary, SimulatorError> {
        let results: Vec<Mutex<Option<ClipSummary>>> =
            self.clips.iter().map(|_| Mutex::new(None)).collect();
        // The threads are not those of rayon: while one of these waits within a clip, it could
        // start another clip.
        let threads = rayon::current_num_threads();
        std::thread::scope(|scope| {
            for _ in 0..threads.min(self.clips.len()) {
                scope.spawn(|| self.run_clips(&results));
            }
        });
        let result = |slot: Mutex<Option<ClipSummary>>| {
            slot.into_inner().unwrap_or_else(PoisonError::into_inner)
        };
        let clips: Vec<ClipSummary> = results
            .into_iter()
            .zip(self.clips)
            .map(|(slot, clip)| {
                result(slot)
                    .unwrap_or_else(|| ClipSummary::of_failed_clip(clip, "not started".to_owned()))
            })
            .collect();
        self.batch_summary(clips)
    }

    /// Takes clips until there are no more.
    fn run_clips(&self, results: &[Mutex<Option<ClipSummary>>]) {
        while !self.hooks.is_cancelled() {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let (Some(clip), Some(slot)) = (self.clips.get(number), results.get(number)) else {
                return;
            };
            let summary = match self.simulate(clip) {
                Ok(summary) => ClipSummary::of_finished_clip(clip, summary),
                Err(SimulatorError::Cancelled) => {
                    ClipSummary::of_failed_clip(clip, INTERRUPTED.to_owned())
                }
                Err(error) => ClipSummary::of_failed_clip(clip, error.to_string()),
            };
            *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(summary);
            self.done.fetch_add(1, Ordering::Relaxed);
            self.report_progress();
        }
    }

    fn simulate(&self, clip: &BatchClip) -> Result<RunSummary, SimulatorError> {
        let source = open(&clip.inputs, &self.config.camera, self.input)?;
        let output = self.staging.folder().join(&clip.output_folder);
        let simulation = Simulation::new(self.config, source)?;
        let done = simulation.run(&output, self.options, &mut ClipHooks(self));
        done.map_err(|error| error.with_shown_paths(self.staging))
    }

    fn report_progress(&self) {
        self.hooks.progress(BatchProgress {
            clips: self.done.load(Ordering::Relaxed),
            total_clips: self.clips.len(),
            frames: self.frames.load(Ordering::Relaxed),
        });
    }

    fn batch_summary(&self, clips: Vec<ClipSummary>) -> Result<BatchSummary, SimulatorError> {
        let partial = clips.iter().filter(|clip| !clip.complete).count();
        if clips.iter().all(|clip| clip.output.is_none()) {
            if self.hooks.is_cancelled() {
                return Err(SimulatorError::Cancelled);
            }
            let first = clips.iter().find_map(|clip| clip.problem.clone()).unwrap_or_default();
            return Err(SimulatorError::NoClip { clips: clips.len(), first });
        }
        let problem = match (self.hooks.is_cancelled(), partial) {
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
    fn progress(&mut self, _: RunProgress) {
        self.0.frames.fetch_add(1, Ordering::Relaxed);
        self.0.report_progress();
    }

    fn is_cancelled(&self) -> bool {
        self.0.hooks.is_cancelled()
    }

    fn interrupt(&self) -> Interrupt {
        self.0.input.interrupt.clone()
    }
}
