// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run in progress: the figures of every frame, and their sums.

use crate::album::Part;
use crate::camera::Seen;
use crate::clips::Audience;
use crate::cost::Costs;
use crate::details::Details;
use crate::frame::{Frame, LayerFrame, counted, mean};
use crate::macs::macs;
use crate::player::Player;
use crate::positions::Positions;
use crate::recording::Recording;
use crate::reference::Reference;
use crate::sight::{Detected, Judge};
use crate::summary::{Summary, Tuning, error, layers, mask_bytes};
use crate::sums::ratio;
use crate::tally::{NotFinite, clip};
use crate::traffic::Traffic;
use crate::{Framing, Goal, InferenceError, Mapping};
use foveate_design::Design;
use foveate_network::Network;
use std::num::NonZeroU32;
use std::time::Instant;

/// The values of the summary that come from the options and not from the frames.
pub(crate) struct Told {
    pub(crate) mode: String,
    /// The name of the accelerator.
    pub(crate) accelerator: Option<String>,
    /// The result of tuning, and its goal.
    pub(crate) tuning: Option<(Tuning, Goal)>,
    pub(crate) problem: Option<String>,
    pub(crate) network: String,
    pub(crate) inputs: Vec<String>,
    pub(crate) mapping: Mapping,
    pub(crate) framing: Framing,
    pub(crate) every: NonZeroU32,
}

/// The result of a finished run.
pub(crate) struct Ended {
    pub(crate) summary: Summary,
    pub(crate) frames: Vec<Frame>,
    /// The detections of the counted frames, if detections were read.
    pub(crate) detected: Option<Detected>,
}

/// The computations that run for comparison.
pub(crate) struct Beside<'a> {
    /// Whether a whole computation of the receiver's screen runs.
    pub(crate) reference: bool,
    /// The network on whole frames, if it runs.
    pub(crate) judge: Option<Judge<'a>>,
}

/// The files of the data that is not kept in memory.
pub(crate) struct Files<'a> {
    pub(crate) outputs: Recording<'a>,
    pub(crate) details: Details,
}

/// A clip or data set that has begun.
struct Begun {
    name: String,
    problem: Option<String>,
    /// The index of the clip's first frame among the frames of all clips.
    first: usize,
    /// The place of the clip's first frame.
    place: u64,
}

/// A run in progress.
pub(crate) struct Run<'a> {
    design: &'a Design,
    network: &'a Network,
    player: Player<'a>,
    reference: Option<Reference<'a>>,
    judge: Option<Judge<'a>>,
    costs: Option<Costs<'a>>,
    files: Files<'a>,
    sums: Vec<Positions>,
    traffic: Vec<Traffic>,
    clips: Vec<Begun>,
    frames: Vec<Frame>,
    not_finite: NotFinite,
}

impl Audience for Run<'_> {
    fn begin(&mut self, clip: &str, black: Option<&[f32]>) {
        let last = self.frames.iter().rev().find(|frame| frame.is_counted);
        self.clips.push(Begun {
            name: clip.to_owned(),
            problem: None,
            first: self.frames.len(),
            place: last.map_or(0, |frame| frame.place + 1),
        });
        self.player.begin(black);
        if let Some(reference) = &mut self.reference {
            reference.outputs.next_clip();
        }
    }

    fn look(&mut self, seen: Seen<'_>) -> Result<(), InferenceError> {
        let (frame, layers) = self.step(seen);
        self.files.details.push(&frame, &layers, self.network, self.costs.as_ref())?;
        self.frames.push(frame);
        self.files.outputs.push(self.player.executor())
    }

    fn end(&mut self, problem: Option<String>) {
        self.clips.last_mut().expect("a clip has begun").problem = problem;
    }
}

impl<'a> Run<'a> {
    pub(crate) fn new(
        design: &'a Design,
        player: Player<'a>,
        beside: Beside<'a>,
        costs: Option<Costs<'a>>,
        files: Files<'a>,
    ) -> Self {
        let network = player.network();
        Self {
            design,
            network,
            player,
            reference: beside.reference.then(|| Reference::new(network)),
            judge: beside.judge,
            costs,
            files,
            sums: vec![Positions::default(); network.nodes().len()],
            traffic: vec![Traffic::default(); network.nodes().len()],
            clips: Vec::new(),
            frames: Vec::new(),
            not_finite: NotFinite::default(),
        }
    }

    /// Runs the network on a frame, and adds the frame to the sums if it counts.
    fn step(&mut self, seen: Seen<'_>) -> (Frame, Vec<LayerFrame>) {
        let start = Instant::now();
        let work = self.player.step(seen).to_vec();
        let seconds = start.elapsed().as_secs_f64();
        let (executor, is_counted) = (self.player.executor(), self.player.is_counted());
        let clip = self.clips.last().expect("a clip has begun");
        self.not_finite.look((&clip.name, seen.number), self.network, executor);
        let judge =
            |reference: &mut Reference<'_>| reference.judge(seen.values, executor, is_counted);
        let close = self.reference.as_mut().map(judge);
        let clip_at = (&clip.name[..], self.clips.len() as u64 - 1);
        let look = |judge: &mut Judge<'_>| judge.look(clip_at, seen, executor, is_counted);
        let sight = self.judge.as_mut().and_then(look);
        let layers = LayerFrame::all(self.network, executor, &work, self.costs.as_ref());
        if is_counted {
            for (node, layer) in layers.iter().enumerate() {
                self.sums[node] += layer.positions;
                self.traffic[node] += layer.traffic;
            }
            if let Some(costs) = &mut self.costs {
                costs.add(layers.iter().filter_map(|layer| layer.cost));
            }
        }
        let regions = u64::from(self.design.regions());
        let frame = Frame {
            place: clip.place + seen.number,
            clip: clip.name.clone(),
            number: seen.number,
            name: seen.name.to_owned(),
            time_us: seen.time_us,
            is_counted,
            active: ratio(seen.active_regions, regions * seen.sent.frames),
            changed: ratio(seen.changed_regions, regions),
            seconds,
            overhead: executor.overhead().as_secs_f64(),
            relative_rms: close.map(|close| close.distance.relative()),
            sight,
            ..Frame::default()
        };
        (frame.of_layers(self.network, &layers, self.costs.as_ref()), layers)
    }

    /// Runs the network on a part of a clip.
    ///
    /// # Errors
    /// Fails if a file cannot be written.
    pub(crate) fn see(&mut self, part: Part<'_>) -> Result<(), InferenceError> {
        self.begin(part.clip, part.black);
        part.frames.iter().try_for_each(|kept| self.look(kept.seen()))
    }

    /// Returns the names of clips with missing frames, each with the reason.
    pub(crate) fn problems(&self) -> Vec<(String, String)> {
        let of = |clip: &Begun| Some((clip.name.clone(), clip.problem.clone()?));
        self.clips.iter().filter_map(of).collect()
    }

    /// Returns whether some frame counts so far.
    pub(crate) fn counts(&self) -> bool {
        self.frames.iter().any(|frame| frame.is_counted)
    }

    /// Returns the number of clips so far.
    pub(crate) fn clips(&self) -> usize {
        self.clips.len()
    }

    /// Ends the run. Returns what is to be written next to the files that grew.
    ///
    /// # Errors
    /// Fails if the files that grew cannot be completed.
    pub(crate) fn end(self, told: Told) -> Result<Ended, InferenceError> {
        let executor = self.player.executor();
        let counted = counted(&self.frames);
        let counted_frames = counted.len() as u64;
        let traffic: Vec<_> = self.traffic.iter().map(|sum| sum.mean(counted_frames)).collect();
        let layers = layers(
            self.network,
            (&self.sums, &traffic),
            executor,
            self.reference.as_ref(),
            self.costs.as_ref(),
        );
        let mut all = Traffic::default();
        self.traffic.iter().for_each(|sum| all += *sum);
        let ends = self.clips.iter().skip(1).map(|clip| clip.first).chain([self.frames.len()]);
        let clips: Vec<_> = self
            .clips
            .iter()
            .zip(ends)
            .map(|(begun, end)| {
                clip(&begun.name, begun.problem.as_ref(), &self.frames[begun.first..end])
            })
            .collect();
        let forms = || (0..=self.network.nodes().len()).map(|value| self.network.form(value));
        let of_weights = self.network.not_finite().iter().map(|(name, count)| {
            format!(
                "the weights `{name}` hold {count} infinite values, or such that are no numbers"
            )
        });
        let is_one = clips.len() == 1;
        let warnings = of_weights.chain(self.not_finite.warning(self.network, is_one)).collect();
        self.files.details.finish()?;
        let summary = Summary {
            format_version: 1,
            foveate_version: env!("CARGO_PKG_VERSION"),
            complete: told.problem.is_none(),
            problem: told.problem,
            warnings,
            inputs: told.inputs,
            network: told.network,
            layout: self.network.layout().name(),
            mode: told.mode,
            mapping: told.mapping,
            framing: told.framing,
            every: told.every,
            width: self.design.width(),
            height: self.design.height(),
            frames: self.frames.len() as u64,
            counted_frames,
            active_share: mean(&counted, |frame| frame.active),
            changed_share: mean(&counted, |frame| frame.changed),
            macs: macs(self.network, &self.sums),
            weight_bytes: layers.iter().map(|layer| layer.weight_bytes).sum(),
            kept_bytes: self.network.kept_bytes(),
            mask_bytes: forms().map(mask_bytes).sum(),
            traffic: all.mean(counted_frames),
            seconds_per_frame: mean(&counted, |frame| frame.seconds),
            overhead_seconds_per_frame: mean(&counted, |frame| frame.overhead),
            accelerator: self
                .costs
                .as_ref()
                .zip(told.accelerator)
                .map(|(costs, name)| costs.summary(&name)),
            error: self.reference.as_ref().map(error),
            tuning: told.tuning.map(|(tuning, goal)| {
                let reference = self.reference.as_ref().expect("what is tuned is compared");
                Tuning { holds: goal.holds(&reference.outputs), ..tuning }
            }),
            sight: self.judge.as_ref().map(Judge::sight),
            outputs: self.files.outputs.finish()?,
            clips,
            design: self.design.fingerprint(),
            configuration: self.design.config(),
            layers,
        };
        let detected = self.judge.and_then(Judge::detected);
        Ok(Ended { summary, frames: self.frames, detected })
    }
}
