// SPDX-License-Identifier: MIT OR Apache-2.0
//! One run: every frame of a source through a camera and a network, into one folder.

use crate::album::Album;
use crate::camera::{Camera, Seen};
use crate::charts::{Drawn, charts};
use crate::cost::Costs;
use crate::page::page;
use crate::player::Player;
use crate::recording::{Record, Recording};
use crate::run::{Ended, Run, Told};
use crate::summary::{Summary, mode_name};
use crate::tune::{Tuned, tune};
use crate::{Goal, InferenceError, Mapping};
use foveate_accelerator::Accelerator;
use foveate_design::{Config, Design};
use foveate_footage::{FootageError, Hooks, Progress, Source, read_ahead};
use foveate_network::{Executor, FrameSize, Mode, Network};
use foveate_staging::{Kind as FolderKind, StagedFolder};
use std::path::{Path, PathBuf};

/// What is computed, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// What is computed for a frame.
    pub computed: Computed,
    /// How pixels become inputs.
    pub mapping: Mapping,
    /// The accelerator whose cost is counted, with its name.
    pub accelerator: Option<(String, Accelerator)>,
    /// Whether a whole computation runs beside, to be compared with.
    pub reference: bool,
    /// What is written of the outputs.
    pub record: Record,
    /// The words of the command line, which the page shows; none if there was no command.
    pub command: Vec<String>,
    /// Whether a folder of an earlier run is replaced.
    pub overwrite: bool,
}

/// What is computed for a frame after the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Computed {
    /// What a mode says.
    Mode(Mode),
    /// What differs by more than a limit, of each layer, that is chosen on the first half of the frames. The second half is reported.
    Tuned(Goal),
}

/// A camera, a network, and the frames to show them.
pub struct Inference {
    design: Design,
    network: Network,
    path: PathBuf,
    source: Box<dyn Source>,
}

impl Inference {
    /// Fits the configuration to the frames of the source, and reads the network for them.
    ///
    /// # Errors
    /// When the configuration is not a valid design, or the network cannot be read or takes frames of another size.
    pub fn new(
        config: &Config,
        network: &Path,
        source: Box<dyn Source>,
    ) -> Result<Self, InferenceError> {
        let mut config = config.clone();
        let (width, height) = source.size();
        let network_for = FrameSize { width: width as usize, height: height as usize };
        let path = network.to_owned();
        let network = Network::read(network, network_for)?;
        config.fit_frame(width, height)?;
        Ok(Self { design: config.validate()?, network, path, source })
    }

    /// Runs to the end of the source, or until `hooks` cancels. The folder `output` appears when everything is written; on an error nothing is left.
    ///
    /// # Errors
    /// When a frame cannot be read, the folder cannot be written, or there is no frame.
    pub fn run(
        self,
        output: &Path,
        options: &Options,
        hooks: &mut dyn Hooks,
    ) -> Result<Summary, InferenceError> {
        let Self { design, network, path, mut source } = self;
        options.mapping.check(network.input().shape()[1])?;
        let staging = StagedFolder::new(output, INFERENCE, options.overwrite)?;
        let mut camera = Camera::new(&design, network.input(), &options.mapping, source.kind());
        let accelerator = options.accelerator.as_ref();
        let costs =
            accelerator.map(|(_, accelerator)| Costs::new(accelerator, &network)).transpose();
        let costs = costs.map_err(|(node, source)| InferenceError::Accelerator { node, source })?;
        let mut recording = Recording::new(&staging, &network, options.record)?;
        let run = |executor, camera: &Camera, reference| {
            Run::new(&design, &network, Player::new(executor, camera.black()), reference, costs)
        };
        let (run, problem, mode, tuning) = match options.computed {
            Computed::Mode(mode) => {
                let mut run = run(Executor::new(&network, mode), &camera, options.reference);
                let problem = watch(source.as_mut(), &mut camera, hooks, |seen| {
                    run.step(seen);
                    recording.push(run.executor())
                })?;
                (run, problem, mode_name(mode), None)
            }
            Computed::Tuned(goal) => {
                let mut album = Album::default();
                let problem = watch(source.as_mut(), &mut camera, hooks, |seen| album.keep(seen))?;
                let (first, second) = album.halves(source.kind())?;
                let Tuned { limits, tuning } =
                    tune(&network, goal, first, camera.black(), album.len(), hooks)?;
                let mut run = run(Executor::truncating(&network, &limits), &camera, true);
                for kept in second {
                    run.step(kept.seen());
                    recording.push(run.executor())?;
                }
                (run, problem, format!("tuned to {goal}"), Some((tuning, goal)))
            }
        };
        let ended = run.end(Told {
            mode,
            accelerator: accelerator.map(|(name, _)| name.clone()),
            tuning,
            problem,
            network: path.display().to_string(),
            inputs: source.inputs().to_vec(),
            mapping: options.mapping.clone(),
            outputs: recording.finish()?,
        });
        write(&staging, &ended)?;
        let page = page(&ended.summary, &ended.counted, &design, &options.command)?;
        staging.write("report.html", page.as_bytes())?;
        staging.commit()?;
        Ok(ended.summary)
    }
}

/// Shows the camera every frame, until the end or `hooks` cancels. Returns why frames are missing, if some are.
fn watch(
    source: &mut dyn Source,
    camera: &mut Camera,
    hooks: &mut dyn Hooks,
    mut visit: impl FnMut(Seen<'_>) -> Result<(), InferenceError>,
) -> Result<Option<String>, InferenceError> {
    let (mut done, total) = (0, source.frames());
    let ended = read_ahead(source, |frames| {
        while let Some(current) = frames.next()? {
            if hooks.cancelled() {
                return Ok::<_, InferenceError>(false);
            }
            visit(camera.see(&current)?)?;
            frames.give_back(current);
            done += 1;
            hooks.progress(Progress { done, total });
        }
        Ok(true)
    })?;
    match (ended, done) {
        (false, 0) => Err(InferenceError::Cancelled),
        (true, 0) => Err(FootageError::NoFrames { inputs: source.inputs().join(", ") }.into()),
        (false, _) => Ok(Some("it was interrupted".to_owned())),
        (true, _) => Ok(source.problem()),
    }
}

impl std::fmt::Debug for Inference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Inference")
            .field("design", &self.design)
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

/// The files of a run.
fn write(staging: &StagedFolder, ended: &Ended) -> Result<(), InferenceError> {
    let Ended { summary, frames, counted } = ended;
    let layers = summary.layer_table();
    let table = |name: &'static str| move |source| InferenceError::Table { name, source };
    staging.write("layers.csv", layers.csv().as_bytes())?;
    staging.write("layers.parquet", &layers.parquet("layers").map_err(table("layers.parquet"))?)?;
    if let Some(tuning) = summary.tuning_table() {
        let parquet = tuning.parquet("tuning").map_err(table("tuning.parquet"))?;
        staging.write("tuning.csv", tuning.csv().as_bytes())?;
        staging.write("tuning.parquet", &parquet)?;
    }
    staging.write("frames.csv", frames.csv().as_bytes())?;
    staging.write("frames.parquet", &frames.parquet("frames").map_err(table("frames.parquet"))?)?;
    for Drawn { chart, .. } in charts(summary, counted) {
        let notes = [chart.caption.clone()];
        staging.write(&format!("{}.svg", chart.file), chart.svg(&notes)?.as_bytes())?;
        staging.write(&format!("{}.png", chart.file), &chart.png()?)?;
    }
    let json = serde_json::to_vec_pretty(summary).expect("a summary has no keys that are not text");
    Ok(staging.write("inference.json", &json)?)
}

/// What a run leaves, and what it may replace.
const INFERENCE: FolderKind =
    FolderKind { what: "an inference (its inference.json)", is: is_inference, listed: true };

fn is_inference(folder: &Path) -> bool {
    folder.join("inference.json").is_file()
}
