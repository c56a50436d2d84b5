// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run: every frame of some clips goes through a camera and a network, and the results go to one
//! folder.

use crate::album::Album;
use crate::camera::Shown;
use crate::charts::{Drawn, charts};
use crate::clips::{Clips, Showing};
use crate::cost::Costs;
use crate::details::Details;
use crate::facts::{DETECTIONS, FRAMES, LAYERS, TRIED, table};
use crate::frame::counted;
use crate::page::page;
use crate::player::{Player, Way};
use crate::recording::{Record, Recording};
use crate::run::{Beside, Ended, Files, Run, Told};
use crate::sight::Judge;
use crate::summary::{Summary, mode_name};
use crate::tune::{Tuned, tune};
use crate::{Goal, InferenceError, Viewing, Witness};
use foveate_accelerator::Accelerator;
use foveate_design::{Config, Design};
use foveate_footage::{Hooks, InputOptions, Source};
use foveate_network::Mode;
use foveate_staging::{FolderKind, StagedFolder};
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

/// The options of a run.
#[derive(Clone, Debug)]
pub struct Options {
    /// The computation for each frame.
    pub computed: Computed,
    /// The accelerator whose cost is counted, with its name.
    pub accelerator: Option<(String, Accelerator)>,
    /// Whether a whole computation also runs, for comparison.
    pub reference: bool,
    /// Whether the network also runs on whole frames, to compare its outputs there.
    pub sight: bool,
    /// Standard deviations of noise in grey levels of 8 bits, each above 0. With `sight`, the
    /// network also runs on whole frames with this noise.
    pub noise: Vec<f64>,
    /// The interval of the frames that the network sees: one of so many frames of a clip, from the
    /// first one. The camera sees all frames.
    pub every: NonZeroU32,
    /// The files of the outputs that are written.
    pub record: Record,
    /// The words of the command line, which the page shows; empty if there was no command.
    pub command: Vec<String>,
    /// Whether the folder of an earlier run is replaced.
    pub overwrite: bool,
}

/// The computation for each frame after the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Computed {
    /// The computation of a mode.
    Mode(Mode),
    /// A computation of the changes above a limit for each layer. The limits are chosen on the
    /// first half of the clips, rounded up, or on the first half of the frames of a single clip.
    /// The second half is reported.
    Tuned(Goal),
}

/// A camera, a network and the clips of a run.
pub struct Inference {
    design: Design,
    witness: Witness,
    viewing: Viewing,
    path: PathBuf,
    clips: Clips,
}

impl Inference {
    /// Opens the inputs, fits the configuration to their frames, and reads the network for them.
    /// Image files together are one clip; every other input is a clip or data set of its own. Each
    /// clip starts with a new camera and a new network. `boxes` are files of ground-truth boxes for
    /// average precision: one for all clips, one for each clip, or none.
    ///
    /// # Errors
    /// Fails if an input cannot be read, clips have different sizes, the configuration is not a
    /// valid design, or the network cannot be read or takes frames of another size.
    pub fn new(
        config: &Config,
        network: &Path,
        viewing: Viewing,
        (inputs, boxes): (&[PathBuf], &[PathBuf]),
        input: &InputOptions,
    ) -> Result<Self, InferenceError> {
        Self::with(config, network, viewing, Clips::new(inputs, boxes, config, input)?)
    }

    /// Creates a run over one clip or data set that is already open.
    ///
    /// # Errors
    /// Fails like [`Inference::new`], but not on inputs.
    pub fn of_source(
        config: &Config,
        network: &Path,
        viewing: Viewing,
        (source, boxes): (Box<dyn Source>, &[PathBuf]),
    ) -> Result<Self, InferenceError> {
        Self::with(config, network, viewing, Clips::of(source, boxes, config)?)
    }

    fn with(
        config: &Config,
        network: &Path,
        viewing: Viewing,
        clips: Clips,
    ) -> Result<Self, InferenceError> {
        let (width, height) = clips.size;
        let witness = Witness::read(network, clips.size, &viewing)?;
        let design = config.for_frames(width, height)?;
        Ok(Self { design, witness, viewing, path: network.to_owned(), clips })
    }

    /// Runs to the end of the clips, or until `hooks` cancels. The folder `output` appears when
    /// everything is written; on an error nothing is left.
    ///
    /// # Errors
    /// Fails if a frame cannot be read, the folder cannot be written, or there is no frame.
    pub fn run(
        self,
        output: &Path,
        options: &Options,
        hooks: &mut dyn Hooks,
    ) -> Result<Summary, InferenceError> {
        let staging = StagedFolder::new(output, INFERENCE, options.overwrite)?;
        let summary = self.write(&staging, options, hooks).map_err(|error| match error {
            InferenceError::Output(error) => InferenceError::Output(staging.named(error)),
            other => other,
        })?;
        staging.commit()?;
        Ok(summary)
    }

    /// Runs the network and writes all files.
    fn write(
        self,
        staging: &StagedFolder,
        options: &Options,
        hooks: &mut dyn Hooks,
    ) -> Result<Summary, InferenceError> {
        let Self { design, witness, viewing, path, mut clips } = self;
        let network = witness.network();
        let accelerator = options.accelerator.as_ref();
        let costs =
            accelerator.map(|(_, accelerator)| Costs::new(accelerator, network)).transpose();
        let costs = costs.map_err(|(node, source)| InferenceError::Accelerator { node, source })?;
        let files = Files {
            outputs: Recording::new(staging, network, options.record)?,
            details: Details::new(staging)?,
        };
        let (all, inputs) = (clips.count(), clips.inputs());
        let with_truth = clips.have_boxes();
        let judge =
            options.sight.then(|| Judge::new(&witness, &design, &options.noise, with_truth));
        let shown = Shown { design: &design, witness: &witness, with_originals: options.sight };
        let mut showing = Showing { shown, clips: &mut clips, every: options.every, done: 0 };
        let run = |way, reference| {
            let beside = Beside { reference, judge };
            Run::new(&design, Player::new(network, way), beside, costs, files)
        };
        let (run, problem, mode, tuning) = match options.computed {
            Computed::Mode(mode) => {
                let mut run = run(Way::Mode(mode), options.reference);
                showing.show(0..all, hooks, &mut run)?;
                let problem = problem(run.problems(), all, run.clips());
                (run, problem, mode_name(mode), None)
            }
            Computed::Tuned(goal) => {
                let mut album = Album::default();
                let tuned_on = all.div_ceil(2);
                if !showing.show(0..tuned_on, hooks, &mut album)? {
                    return Err(InferenceError::Cancelled);
                }
                let (parts, rest) = album.parts(all)?;
                let Tuned { limits, tuning } = tune(network, goal, &parts, album.frames(), hooks)?;
                let mut run = run(Way::Limits(limits), true);
                if let Some(rest) = rest {
                    run.see(rest)?;
                }
                let is_whole = showing.show(tuned_on..all, hooks, &mut run)?;
                match (run.counts(), is_whole) {
                    (true, _) => {}
                    (false, true) => {
                        return Err(InferenceError::NothingCounts {
                            clips: "clips that it reports",
                        });
                    }
                    (false, false) => return Err(InferenceError::Cancelled),
                }
                let problems = [album.problems(), run.problems()].concat();
                let problem = problem(problems, all, tuned_on.min(all - 1) + run.clips());
                (run, problem, format!("tuned to {goal}"), Some((tuning, goal)))
            }
        };
        let ended = run.end(Told {
            mode,
            accelerator: accelerator.map(|(name, _)| name.clone()),
            tuning,
            problem,
            network: path.display().to_string(),
            inputs,
            mapping: viewing.mapping,
            framing: viewing.framing,
            every: options.every,
        })?;
        write(staging, &ended)?;
        let Ended { summary, frames, detected } = &ended;
        let shots = detected.as_ref().map(|detected| &detected.shots);
        let page = page(summary, frames, shots, &design, &options.command)?;
        staging.write("report.html", page.as_bytes())?;
        Ok(ended.summary)
    }
}

/// Returns the reason for missing frames, if some are missing. A single clip is not named.
fn problem(clips: Vec<(String, String)>, all: usize, begun: usize) -> Option<String> {
    let named = |(clip, problem): (String, String)| {
        if all == 1 { problem } else { format!("`{clip}`: {problem}") }
    };
    let missing = all - begun;
    let others = (missing > 0).then(|| format!("clips that were not begun: {missing}"));
    let problems: Vec<_> = clips.into_iter().map(named).chain(others).collect();
    (!problems.is_empty()).then(|| problems.join("; "))
}

impl std::fmt::Debug for Inference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Inference")
            .field("design", &self.design)
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

/// Writes the tables, the charts and the summary of a run.
fn write(staging: &StagedFolder, ended: &Ended) -> Result<(), InferenceError> {
    let Ended { summary, frames, detected } = ended;
    let layers = (0..).zip(&summary.layers);
    let of_frames = frames.iter().map(|frame| (frame.number, frame));
    let tried: Option<Vec<_>> = summary.tuning.as_ref().map(|tuning| tuning.tried().collect());
    let tried = tried.map(|tried| table(None, TRIED, (0..).zip(&tried)));
    let mut tables = vec![("layers", table(Some("layer"), LAYERS, layers))];
    tables.push(("frames", table(Some("frame"), FRAMES, of_frames)));
    tables.extend(tried.map(|tried| ("tuning", tried)));
    if let Some(detected) = detected {
        tables.push(("detections", table(None, DETECTIONS, (0..).zip(&detected.rows))));
    }
    for (name, table) in tables {
        let file = format!("{name}.parquet");
        let parquet = table.parquet(name);
        let parquet =
            parquet.map_err(|source| InferenceError::Table { name: file.clone(), source })?;
        staging.write(&format!("{name}.csv"), table.csv().as_bytes())?;
        staging.write(&file, &parquet)?;
    }
    for Drawn { chart, .. } in charts(summary, &counted(frames)) {
        let notes = [chart.caption.clone()];
        staging.write(&format!("{}.svg", chart.file), chart.svg(&notes)?.as_bytes())?;
        staging.write(&format!("{}.png", chart.file), &chart.png()?)?;
    }
    let json = serde_json::to_vec_pretty(summary).expect("a summary has no keys that are not text");
    Ok(staging.write("inference.json", &json)?)
}

/// The kind of folder that a run writes, and the only kind that it replaces.
pub const INFERENCE: FolderKind =
    FolderKind { what: "an inference (its inference.json)", is: is_inference };

fn is_inference(folder: &Path) -> bool {
    folder.join("inference.json").is_file()
}
