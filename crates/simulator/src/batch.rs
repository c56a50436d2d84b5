// SPDX-License-Identifier: MIT OR Apache-2.0
//! Many clips in one run: one output folder per clip, in a tree like that of the inputs, and one
//! summary of the batch. If a clip fails, the others are still completed.

mod summary;

pub use summary::{BatchSummary, ClipSummary};

use std::path::Path;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use foveate_design::Config;
use foveate_staging::StagedFolder;
use foveate_toolchain::Interrupt;

use crate::output::INTERRUPTED;
use crate::simulation::SIMULATION;
use crate::{Hooks, Progress, RunOptions, Simulation, SimulatorError, Summary};
use foveate_footage::{Clip, InputOptions, open};

/// The progress of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BatchProgress {
    /// The number of clips that are done or have failed.
    pub clips: usize,
    /// The number of all clips.
    pub all: usize,
    /// The number of frames of all clips so far.
    pub frames: u64,
}

/// The callbacks of a batch. Several threads call them.
pub trait BatchHooks: Sync {
    /// Reports that another frame or clip is done.
    fn progress(&self, progress: BatchProgress);

    /// Returns true if the batch is to stop. The result is then incomplete, and is marked so.
    fn cancelled(&self) -> bool;
}

/// Runs every clip into a folder below `output`, with as many clips in parallel as rayon has
/// threads. The folder `output` appears at the end.
///
/// # Errors
/// Fails if the output cannot be written, or if no clip could be simulated.
pub fn run_batch(
    clips: &[Clip],
    config: &Config,
    input: &InputOptions,
    output: &Path,
    options: &RunOptions,
    hooks: &dyn BatchHooks,
) -> Result<BatchSummary, SimulatorError> {
    let staging = StagedFolder::new(output, SIMULATION, options.overwrite)?;
    let batch = Batch {
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
struct Batch<'a> {
    clips: &'a [Clip],
    config: &'a Config,
    input: &'a InputOptions,
    options: &'a RunOptions,
    hooks: &'a dyn BatchHooks,
    staging: &'a StagedFolder,
    next: AtomicUsize,
    done: AtomicUsize,
    frames: AtomicU64,
}

impl Batch<'_> {
    fn run(&self) -> Result<BatchSummary, SimulatorError> {
        let results: Vec<Mutex<Option<ClipSummary>>> =
            self.clips.iter().map(|_| Mutex::new(None)).collect();
        // The threads are not those of rayon: while one of these waits within a clip, it could
        // start another clip.
        let threads = rayon::current_num_threads();
        std::thread::scope(|scope| {
            for _ in 0..threads.min(self.clips.len()) {
                scope.spawn(|| self.work(&results));
            }
        });
        let result = |slot: Mutex<Option<ClipSummary>>| {
            slot.into_inner().unwrap_or_else(PoisonError::into_inner)
        };
        let clips: Vec<ClipSummary> = results
            .into_iter()
            .zip(self.clips)
            .map(|(slot, clip)| {
                result(slot).unwrap_or_else(|| ClipSummary::failed(clip, "not started".to_owned()))
            })
            .collect();
        self.conclude(clips)
    }

    /// Takes clips until there are no more.
    fn work(&self, results: &[Mutex<Option<ClipSummary>>]) {
        while !self.hooks.cancelled() {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let (Some(clip), Some(slot)) = (self.clips.get(number), results.get(number)) else {
                return;
            };
            let summary = match self.simulate(clip) {
                Ok(summary) => ClipSummary::done(clip, summary),
                Err(SimulatorError::Cancelled) => ClipSummary::failed(clip, INTERRUPTED.to_owned()),
                Err(error) => ClipSummary::failed(clip, error.to_string()),
            };
            *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(summary);
            self.done.fetch_add(1, Ordering::Relaxed);
            self.tell();
        }
    }

    fn simulate(&self, clip: &Clip) -> Result<Summary, SimulatorError> {
        let source = open(&clip.inputs, &self.config.camera, self.input)?;
        let output = self.staging.folder().join(&clip.place);
        let simulation = Simulation::new(self.config, source)?;
        let done = simulation.run(&output, self.options, &mut Frames(self));
        done.map_err(|error| error.named(self.staging))
    }

    fn tell(&self) {
        self.hooks.progress(BatchProgress {
            clips: self.done.load(Ordering::Relaxed),
            all: self.clips.len(),
            frames: self.frames.load(Ordering::Relaxed),
        });
    }

    fn conclude(&self, clips: Vec<ClipSummary>) -> Result<BatchSummary, SimulatorError> {
        let partial = clips.iter().filter(|clip| !clip.complete).count();
        if clips.iter().all(|clip| clip.output.is_none()) {
            if self.hooks.cancelled() {
                return Err(SimulatorError::Cancelled);
            }
            let first = clips.iter().find_map(|clip| clip.problem.clone()).unwrap_or_default();
            return Err(SimulatorError::NoClip { clips: clips.len(), first });
        }
        let problem = match (self.hooks.cancelled(), partial) {
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
struct Frames<'a>(&'a Batch<'a>);

impl Hooks for Frames<'_> {
    fn progress(&mut self, _: Progress) {
        self.0.frames.fetch_add(1, Ordering::Relaxed);
        self.0.tell();
    }

    fn cancelled(&self) -> bool {
        self.0.hooks.cancelled()
    }

    fn interrupt(&self) -> Interrupt {
        self.0.input.interrupt.clone()
    }
}
