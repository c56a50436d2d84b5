// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run: every frame of some clips goes through a camera and a network, and the results go to one
//! folder.

use super::clip_playback::KeptClips;
use super::run::{ExecutorMode, NetworkRunner};
use crate::camera::CameraSetup;
use crate::charts::{ChartWithIds, charts};
use crate::clip_playback::ClipPlayback;
use crate::cost::NodeCosts;
use crate::frame::counted_frames;
use crate::layer_frame_table::LayerFrameTable;
use crate::page::render_page;
use crate::recording::{OutputRecorder, RecordOptions};
use crate::run::{FinishedRun, InferenceRun, RunComparisons, RunFiles, RunMetadata};
use crate::summary::InferenceSummary;
use crate::table_columns::{FRAMES, LAYERS, TRIALS, detection_table, table};
use crate::tuning::{TunedLimits, tune};
use crate::whole_frames::WholeFrameComparison;
use crate::{Computation, InferenceError, VisionNetwork, VisionOptions};
use foveate_design::{Design, DesignConfig};
use foveate_media::{
    ClipPlayer, ClipReading, CommonFormat, InputOptions, PlaybackError, RunClips, RunHooks,
    RunMonitor,
};
use foveate_network::accelerator::Accelerator;
use foveate_tools::{FolderKind, StagedFolder, open_file};
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

/// The options of a run.
#[derive(Clone, Debug)]
pub struct InferenceOptions {
    /// The computation for each frame.
    pub computation: Computation,
    /// The accelerator whose cost is counted, with its name.
    pub accelerator: Option<(String, Accelerator)>,
    /// True if a whole computation also runs, for comparison.
    pub with_whole_computation: bool,
    /// True if the network also runs on whole frames, to compare its outputs there.
    pub with_whole_frames: bool,
    /// Standard deviations of noise in grey levels of 8 bits, each above 0. The network also runs
    /// on whole frames with this noise if `with_whole_frames` is set.
    pub noise: Vec<f64>,
    /// The distance between the frames of a clip that the network sees. With 1 it sees all frames,
    /// and with 3 the first frame, the fourth and so on. The camera sees all frames.
    pub frame_interval: NonZeroU32,
    /// The files of the outputs that are written.
    pub record: RecordOptions,
    /// The words of the command line, which the page shows; empty if there was no command.
    pub command: Vec<String>,
    /// True if the folder of an earlier run is replaced.
    pub overwrite: bool,
}

/// A camera, a network and the clips of a run.
pub struct Inference {
    design: Design,
    vision_network: VisionNetwork,
    vision_options: VisionOptions,
    path: PathBuf,
    clips: RunClips,
    /// The number of frames of all clips, if it is known.
    frames: Option<u64>,
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
        config: &DesignConfig,
        network: &Path,
        vision_options: VisionOptions,
        (inputs, boxes): (&[PathBuf], &[PathBuf]),
        input: &InputOptions,
    ) -> Result<Self, InferenceError> {
        let clips = RunClips::new(inputs, boxes, &config.camera, input)?;
        Self::from_clips(config, network, vision_options, clips)
    }

    /// Creates a run over one clip or data set that is already open.
    ///
    /// # Errors
    /// Fails like [`Inference::new`], but not on inputs.
    pub fn from_player(
        config: &DesignConfig,
        network: &Path,
        vision_options: VisionOptions,
        (player, boxes): (impl Into<ClipPlayer>, &[PathBuf]),
    ) -> Result<Self, InferenceError> {
        let clips = RunClips::from_player(player.into(), boxes)?;
        Self::from_clips(config, network, vision_options, clips)
    }

    fn from_clips(
        config: &DesignConfig,
        network: &Path,
        vision_options: VisionOptions,
        clips: RunClips,
    ) -> Result<Self, InferenceError> {
        let CommonFormat { size, frames } = clips.common_format(ClipReading::Once)?;
        let vision_network = VisionNetwork::read(network, open_file, size, &vision_options)?;
        let design = config.validate_for_frames(size.0, size.1)?;
        Ok(Self { design, vision_network, vision_options, path: network.to_owned(), clips, frames })
    }

    /// Runs to the end of the clips, or until `hooks` cancels. The folder `output` appears when
    /// everything is written; on an error nothing is left.
    ///
    /// # Errors
    /// Fails if a frame cannot be read, the folder cannot be written, or there is no frame.
    pub fn run(
        self,
        output: &Path,
        options: &InferenceOptions,
        hooks: &dyn RunHooks,
    ) -> Result<InferenceSummary, InferenceError> {
        let staging = StagedFolder::new(output, INFERENCE_FOLDER, options.overwrite)?;
        let summary = self.write_files(&staging, options, hooks).map_err(|error| match error {
            InferenceError::Output(error) => InferenceError::Output(staging.with_shown_path(error)),
            other => other,
        })?;
        staging.commit()?;
        Ok(summary)
    }

    /// Runs the network and writes all files.
    fn write_files(
        self,
        staging: &StagedFolder,
        options: &InferenceOptions,
        hooks: &dyn RunHooks,
    ) -> Result<InferenceSummary, InferenceError> {
        let Self { design, vision_network, vision_options, path, clips, frames } = self;
        let network = vision_network.network();
        let accelerator = options.accelerator.as_ref();
        let costs =
            accelerator.map(|(_, accelerator)| NodeCosts::new(accelerator, network)).transpose();
        let costs = costs.map_err(|(node, source)| InferenceError::Accelerator { node, source })?;
        let files = RunFiles {
            outputs: OutputRecorder::new(staging, network, options.record)?,
            details: LayerFrameTable::new(staging)?,
        };
        let (all, inputs) = (clips.clips().len(), clips.inputs());
        let luma = clips.options().luma;
        let with_truth = clips.boxes(0).is_some();
        let judge = options.with_whole_frames.then(|| {
            WholeFrameComparison::new(&vision_network, &design, &options.noise, with_truth)
        });
        let shown = CameraSetup {
            design: &design,
            vision_network: &vision_network,
            with_originals: options.with_whole_frames,
        };
        let playback = ClipPlayback {
            setup: shown,
            clips: &clips,
            every: options.frame_interval,
            monitor: RunMonitor::of_frames(hooks, frames),
        };
        let run = |way, reference| {
            let beside = RunComparisons { with_whole_computation: reference, whole_frames: judge };
            InferenceRun::new(&design, NetworkRunner::new(network, way), beside, costs, files)
        };
        let (run, problem, tuning) = match options.computation {
            Computation::Mode(mode) => {
                let mut run = run(ExecutorMode::Mode(mode), options.with_whole_computation);
                playback.play_clips(0..all, &mut run)?;
                let problem = missing_frames_reason(run.problems(), all, run.clip_count());
                (run, problem, None)
            }
            Computation::Tuned(goal) => {
                let mut album = KeptClips::default();
                let tuned_on = all.div_ceil(2);
                if !playback.play_clips(0..tuned_on, &mut album)? {
                    return Err(PlaybackError::Interrupted.into());
                }
                let (parts, rest) = album.tuning_parts(all)?;
                let TunedLimits { limits, tuning } =
                    tune(network, goal, &parts, album.frames(), hooks)?;
                let mut run = run(ExecutorMode::Limits(limits), true);
                if let Some(rest) = rest {
                    run.run_part(rest)?;
                }
                let is_whole = playback.play_clips(tuned_on..all, &mut run)?;
                match (run.has_counted_frames(), is_whole) {
                    (true, _) => {}
                    (false, true) => {
                        return Err(InferenceError::NoCountedFrame { clips: "clips to report" });
                    }
                    (false, false) => return Err(PlaybackError::Interrupted.into()),
                }
                let problems = [album.problems(), run.problems()].concat();
                let problem =
                    missing_frames_reason(problems, all, tuned_on.min(all - 1) + run.clip_count());
                (run, problem, Some((tuning, goal)))
            }
        };
        let ended = run.finish(RunMetadata {
            computation: options.computation,
            accelerator: accelerator.map(|(name, _)| name.clone()),
            tuning,
            problem,
            network: path.display().to_string(),
            inputs,
            luma,
            mapping: vision_options.mapping,
            framing: vision_options.framing,
            every: options.frame_interval,
        })?;
        write_tables_and_charts(staging, &ended)?;
        let FinishedRun { summary, frames, detections: detected } = &ended;
        let shots = detected.as_ref().map(|detected| &detected.shots);
        let page = render_page(summary, frames, shots, &design, &options.command)?;
        staging.write("report.html", page.as_bytes())?;
        Ok(ended.summary)
    }
}

/// Returns the reason for missing frames, if some are missing. A single clip is not named.
fn missing_frames_reason(clips: Vec<(String, String)>, all: usize, begun: usize) -> Option<String> {
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

fn write_tables_and_charts(
    staging: &StagedFolder,
    ended: &FinishedRun,
) -> Result<(), InferenceError> {
    let FinishedRun { summary, frames, detections: detected } = ended;
    let layers = (0..).zip(&summary.layers);
    let of_frames = frames.iter().map(|frame| (frame.number, frame));
    let tried: Option<Vec<_>> =
        summary.tuning.as_ref().map(|tuning| tuning.named_trials().collect());
    let tried = tried.map(|tried| table(None, TRIALS, (0..).zip(&tried)));
    let mut tables = vec![("layers", table(Some("layer"), LAYERS, layers))];
    tables.push(("frames", table(Some("frame"), FRAMES, of_frames)));
    tables.extend(tried.map(|tried| ("tuning", tried)));
    if let Some(detected) = detected {
        tables.push(("detections", detection_table(&detected.rows)));
    }
    for (name, table) in tables {
        let file = format!("{name}.parquet");
        let parquet = table.to_parquet(name);
        let parquet =
            parquet.map_err(|source| InferenceError::Table { name: file.clone(), source })?;
        staging.write(&format!("{name}.csv"), table.to_csv().as_bytes())?;
        staging.write(&file, &parquet)?;
    }
    for ChartWithIds { chart, .. } in charts(summary, &counted_frames(frames)) {
        let notes = [chart.caption.clone()];
        staging.write(&format!("{}.svg", chart.file_stem), chart.to_svg(&notes)?.as_bytes())?;
        staging.write(&format!("{}.png", chart.file_stem), &chart.to_png()?)?;
    }
    let json = serde_json::to_vec_pretty(summary).expect("a summary has no keys that are not text");
    Ok(staging.write("inference.json", &json)?)
}

/// The kind of folder that a run writes, and the only kind that it replaces.
pub const INFERENCE_FOLDER: FolderKind =
    FolderKind { description: "an inference (its inference.json)", matches: is_inference };

fn is_inference(folder: &Path) -> bool {
    folder.join("inference.json").is_file()
}
