// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run of a network over clips, or over the frames of data sets one by one
//! ([`InferenceRun`]): the figures of every frame, and their sums. Each clip has an executor of
//! its own ([`NetworkRunner`]).

use super::clip_playback::ClipPart;
use super::computation::{PositionCounts, WholeComputation, macs_of_layers, share};
use super::cost::TrafficTally;
use super::frame::{NotFiniteTally, clip_summary};
use crate::camera::ReceivedFrame;
use crate::clip_playback::FrameConsumer;
use crate::cost::NodeCosts;
use crate::frame::{FrameFigures, LayerFigures, counted_frames, mean_of_frames};
use crate::layer_frame_table::LayerFrameTable;
use crate::recording::OutputRecorder;
use crate::summary::{
    InferenceSummary, TuningSummary, layer_summaries, mask_bytes, whole_computation_error,
};
use crate::whole_frames::{CountedDetections, WholeFrameComparison};
use crate::{Computation, Framing, InferenceError, PixelMapping, TuningGoal};
use foveate_design::Design;
use foveate_media::LumaRange;
use foveate_network::{ExecutionMode, Executor, Mask, Network, NodeWork};
use std::num::NonZeroU32;
use std::time::Instant;

/// The values of the summary that come from the options and not from the frames.
pub(crate) struct RunMetadata {
    pub(crate) computation: Computation,
    pub(crate) accelerator: Option<String>,
    /// The result of tuning, and its goal.
    pub(crate) tuning: Option<(TuningSummary, TuningGoal)>,
    pub(crate) problem: Option<String>,
    pub(crate) network: String,
    pub(crate) inputs: Vec<String>,
    pub(crate) luma: LumaRange,
    pub(crate) mapping: PixelMapping,
    pub(crate) framing: Framing,
    pub(crate) every: NonZeroU32,
}

/// The result of a finished run.
pub(crate) struct FinishedRun {
    pub(crate) summary: InferenceSummary,
    pub(crate) frames: Vec<FrameFigures>,
    /// The detections of the counted frames, if detections were read.
    pub(crate) detections: Option<CountedDetections>,
}

/// The computations that run for comparison.
pub(crate) struct RunComparisons<'a> {
    /// True if a whole computation of the receiver's screen runs.
    pub(crate) with_whole_computation: bool,
    /// The network on whole frames, if it runs.
    pub(crate) whole_frames: Option<WholeFrameComparison<'a>>,
}

/// The files of the data that is not kept in memory.
pub(crate) struct RunFiles<'a> {
    pub(crate) outputs: OutputRecorder<'a>,
    pub(crate) details: LayerFrameTable,
}

/// A clip or data set that has begun.
struct BegunClip {
    name: String,
    problem: Option<String>,
    /// The index of the clip's first frame among the frames of all clips.
    first: usize,
    /// The `index_in_run` of the clip's first frame.
    first_index_in_run: u64,
}

/// A run in progress.
pub(crate) struct InferenceRun<'a> {
    design: &'a Design,
    network: &'a Network,
    player: NetworkRunner<'a>,
    reference: Option<WholeComputation<'a>>,
    judge: Option<WholeFrameComparison<'a>>,
    costs: Option<NodeCosts<'a>>,
    files: RunFiles<'a>,
    sums: Vec<PositionCounts>,
    traffic: Vec<TrafficTally>,
    clips: Vec<BegunClip>,
    frames: Vec<FrameFigures>,
    not_finite: NotFiniteTally,
}

impl FrameConsumer for InferenceRun<'_> {
    fn begin_clip(&mut self, clip: &str, black: Option<&[f32]>) {
        self.clips.push(BegunClip {
            name: clip.to_owned(),
            problem: None,
            first: self.frames.len(),
            first_index_in_run: self.frames.last().map_or(0, |last| last.index_in_run + 1),
        });
        self.player.begin(black);
        if let Some(reference) = &mut self.reference {
            reference.outputs.next_clip();
        }
    }

    fn take_frame(&mut self, seen: ReceivedFrame<'_>) -> Result<(), InferenceError> {
        let (frame, layers) = self.step(seen);
        self.files.details.push(&frame, &layers, self.network, self.costs.as_ref())?;
        self.frames.push(frame);
        self.files.outputs.push(self.player.executor())
    }

    fn end_clip(&mut self, problem: Option<String>) {
        self.clips.last_mut().expect("a clip has begun").problem = problem;
    }
}

impl<'a> InferenceRun<'a> {
    pub(crate) fn new(
        design: &'a Design,
        player: NetworkRunner<'a>,
        beside: RunComparisons<'a>,
        costs: Option<NodeCosts<'a>>,
        files: RunFiles<'a>,
    ) -> Self {
        let network = player.network();
        Self {
            design,
            network,
            player,
            reference: beside.with_whole_computation.then(|| WholeComputation::new(network)),
            judge: beside.whole_frames,
            costs,
            files,
            sums: vec![PositionCounts::default(); network.nodes().len()],
            traffic: vec![TrafficTally::default(); network.nodes().len()],
            clips: Vec::new(),
            frames: Vec::new(),
            not_finite: NotFiniteTally::default(),
        }
    }

    /// Runs the network on a frame, and adds the frame to the sums if it counts.
    fn step(&mut self, seen: ReceivedFrame<'_>) -> (FrameFigures, Vec<LayerFigures>) {
        let start = Instant::now();
        let work = self.player.step(seen).to_vec();
        let seconds = start.elapsed().as_secs_f64();
        let (executor, is_counted) = (self.player.executor(), self.player.is_counted());
        let clip = self.clips.last().expect("a clip has begun");
        self.not_finite.check_outputs((&clip.name, seen.number), self.network, executor);
        let judge = |reference: &mut WholeComputation<'_>| {
            reference.compare(seen.values, executor, is_counted)
        };
        let close = self.reference.as_mut().map(judge);
        let clip_at = (&clip.name[..], self.clips.len() as u64 - 1);
        let look = |judge: &mut WholeFrameComparison<'_>| {
            judge.compare_frame(clip_at, seen, executor, is_counted)
        };
        let sight = self.judge.as_mut().and_then(look);
        let layers = LayerFigures::of_all_nodes(self.network, executor, &work, self.costs.as_ref());
        if is_counted {
            for (node, layer) in layers.iter().enumerate() {
                self.sums[node] += layer.positions;
                self.traffic[node] += layer.traffic;
            }
            if let Some(costs) = &mut self.costs {
                costs.add_frame(layers.iter().filter_map(|layer| layer.cost));
            }
        }
        let regions = u64::from(self.design.regions());
        let frame = FrameFigures {
            index_in_run: clip.first_index_in_run + seen.number,
            clip: clip.name.clone(),
            number: seen.number,
            name: seen.name.to_owned(),
            time_us: seen.time_us,
            is_counted,
            active_share: share(seen.active_regions, regions * seen.sent.frames),
            changed_share: share(seen.changed_regions, regions),
            seconds,
            overhead_seconds: executor.overhead().as_secs_f64(),
            relative_rms: close.map(|close| close.distance.relative_rms()),
            whole_frame_agreement: sight,
            ..FrameFigures::default()
        };
        (frame.with_layers(self.network, &layers, self.costs.as_ref()), layers)
    }

    /// Runs the network on a part of a clip.
    ///
    /// # Errors
    /// Fails if a file cannot be written.
    pub(crate) fn run_part(&mut self, part: ClipPart<'_>) -> Result<(), InferenceError> {
        self.begin_clip(part.clip, part.black);
        part.frames.iter().try_for_each(|kept| self.take_frame(kept.as_received()))
    }

    /// Returns the names of clips with missing frames, each with the reason.
    pub(crate) fn problems(&self) -> Vec<(String, String)> {
        let of = |clip: &BegunClip| Some((clip.name.clone(), clip.problem.clone()?));
        self.clips.iter().filter_map(of).collect()
    }

    /// Returns whether some frame counts so far.
    pub(crate) fn has_counted_frames(&self) -> bool {
        self.frames.iter().any(|frame| frame.is_counted)
    }

    /// Returns the number of clips so far.
    pub(crate) fn clip_count(&self) -> usize {
        self.clips.len()
    }

    /// Ends the run. Returns the results that are to be written next to the files that grew.
    ///
    /// # Errors
    /// Fails if the files that grew cannot be completed.
    pub(crate) fn finish(self, told: RunMetadata) -> Result<FinishedRun, InferenceError> {
        let executor = self.player.executor();
        let counted = counted_frames(&self.frames);
        let counted_frames = counted.len() as u64;
        let traffic: Vec<_> = self.traffic.iter().map(|sum| sum.mean(counted_frames)).collect();
        let layers = layer_summaries(
            self.network,
            (&self.sums, &traffic),
            executor,
            self.reference.as_ref(),
            self.costs.as_ref(),
        );
        let mut all = TrafficTally::default();
        self.traffic.iter().for_each(|sum| all += *sum);
        let ends = self.clips.iter().skip(1).map(|clip| clip.first).chain([self.frames.len()]);
        let clips: Vec<_> = self
            .clips
            .iter()
            .zip(ends)
            .map(|(begun, end)| {
                clip_summary(&begun.name, begun.problem.as_ref(), &self.frames[begun.first..end])
            })
            .collect();
        let forms = || (0..=self.network.nodes().len()).map(|value| self.network.form(value));
        let of_weights = self.network.non_finite_weights().iter().map(|(name, count)| {
            format!("the weights `{name}` hold {count} values that are infinite or not a number")
        });
        let is_one = clips.len() == 1;
        let warnings = of_weights.chain(self.not_finite.warning(self.network, is_one)).collect();
        self.files.details.finish()?;
        let summary = InferenceSummary {
            format_version: 1,
            foveate_version: env!("CARGO_PKG_VERSION"),
            complete: told.problem.is_none(),
            problem: told.problem,
            warnings,
            inputs: told.inputs,
            luma: told.luma.name(),
            network: told.network,
            layout: self.network.layout().name(),
            mode: told.computation,
            mapping: told.mapping,
            framing: told.framing,
            every: told.every,
            width: self.design.width(),
            height: self.design.height(),
            frames: self.frames.len() as u64,
            counted_frames,
            active_share: mean_of_frames(&counted, |frame| frame.active_share),
            changed_share: mean_of_frames(&counted, |frame| frame.changed_share),
            macs: macs_of_layers(self.network, &self.sums),
            weight_bytes: layers.iter().map(|layer| layer.weight_bytes).sum(),
            kept_bytes: self.network.kept_bytes(),
            mask_bytes: forms().map(mask_bytes).sum(),
            traffic: all.mean(counted_frames),
            seconds_per_frame: mean_of_frames(&counted, |frame| frame.seconds),
            overhead_seconds_per_frame: mean_of_frames(&counted, |frame| frame.overhead_seconds),
            accelerator: self
                .costs
                .as_ref()
                .zip(told.accelerator)
                .map(|(costs, name)| costs.summary(&name)),
            error: self.reference.as_ref().map(whole_computation_error),
            tuning: told.tuning.map(|(tuning, goal)| {
                let reference = self.reference.as_ref().expect("what is tuned is compared");
                TuningSummary { holds: goal.is_reached_by(&reference.outputs), ..tuning }
            }),
            sight: self.judge.as_ref().map(WholeFrameComparison::summary),
            outputs: self.files.outputs.finish()?,
            clips,
            design: self.design.fingerprint(),
            configuration: self.design.config(),
            layers,
        };
        let detected = self.judge.and_then(WholeFrameComparison::into_detections);
        Ok(FinishedRun { summary, frames: self.frames, detections: detected })
    }
}

/// The computation of an executor.
#[derive(Clone, Debug)]
pub(crate) enum ExecutorMode {
    Mode(ExecutionMode),
    /// A computation of the changes above a limit for each node.
    Limits(Vec<f32>),
}

/// Runs a network over frames. Every clip starts with a new executor.
#[derive(Clone, Debug)]
pub(crate) struct NetworkRunner<'a> {
    network: &'a Network,
    mode: ExecutorMode,
    /// The executor of the current clip, once one has begun.
    clip_executor: Option<ClipExecutor<'a>>,
}

/// An executor in a clip or data set.
#[derive(Clone, Debug)]
struct ClipExecutor<'a> {
    executor: Executor<'a>,
    /// The executor after a black screen, from which every frame of a data set starts; `None` for a
    /// clip.
    black: Option<Executor<'a>>,
    /// The number of frames so far.
    frames: u64,
}

impl<'a> NetworkRunner<'a> {
    pub(crate) fn new(network: &'a Network, way: ExecutorMode) -> Self {
        Self { network, mode: way, clip_executor: None }
    }

    pub(crate) fn network(&self) -> &'a Network {
        self.network
    }

    /// Begins a clip, or a data set if `black` is its input for a black screen.
    pub(crate) fn begin(&mut self, black: Option<&[f32]>) {
        // The memory of the clip before is freed first.
        self.clip_executor = None;
        let mut executor = match &self.mode {
            ExecutorMode::Mode(mode) => Executor::new(self.network, *mode),
            ExecutorMode::Limits(limits) => Executor::with_limits(self.network, limits),
        };
        let form = self.network.input();
        let black = black.map(|picture| {
            executor.step(picture, &Mask::full(form.height(), form.width()));
            executor.clone()
        });
        self.clip_executor = Some(ClipExecutor { executor, black, frames: 0 });
    }

    /// Runs the network on the next frame. Returns the work of every node.
    pub(crate) fn step(&mut self, seen: ReceivedFrame<'_>) -> &[NodeWork] {
        let playing = self.clip_executor.as_mut().expect(CLIP_HAS_BEGUN);
        if let Some(black) = &playing.black {
            playing.executor.clone_from(black);
        }
        playing.frames += 1;
        playing.executor.step(seen.values, seen.changed)
    }

    /// Returns whether the last frame counts: every frame of a data set, and every frame of a clip
    /// but the first, which is computed whole.
    pub(crate) fn is_counted(&self) -> bool {
        let playing = self.clip_executor.as_ref().expect(CLIP_HAS_BEGUN);
        playing.black.is_some() || playing.frames > 1
    }

    pub(crate) fn executor(&self) -> &Executor<'a> {
        &self.clip_executor.as_ref().expect(CLIP_HAS_BEGUN).executor
    }
}

const CLIP_HAS_BEGUN: &str = "a clip has begun";
