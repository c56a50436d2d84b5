// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run under way: what every frame did, and the sums.

use crate::album::Part;
use crate::camera::Seen;
use crate::charts::Counted;
use crate::clips::Audience;
use crate::cost::Costs;
use crate::details::Details;
use crate::frame::Frame;
use crate::macs::macs;
use crate::player::Player;
use crate::positions::Positions;
use crate::recording::Recording;
use crate::reference::Reference;
use crate::summary::{Summary, Tuning, error, layers, mask_bytes};
use crate::sums::{ratio, sum};
use crate::tally::{ClipSums, NotFinite};
use crate::traffic::Traffic;
use crate::{Goal, InferenceError, Mapping};
use foveate_design::Design;
use foveate_files::tables::{Cells, Table};
use foveate_network::Network;
use std::time::Instant;

/// What a summary says that no frame says.
pub(crate) struct Told {
    pub(crate) mode: String,
    /// What the accelerator is called.
    pub(crate) accelerator: Option<String>,
    /// With its goal.
    pub(crate) tuning: Option<(Tuning, Goal)>,
    pub(crate) problem: Option<String>,
    pub(crate) network: String,
    pub(crate) inputs: Vec<String>,
    pub(crate) mapping: Mapping,
}

/// A run at its end.
pub(crate) struct Ended {
    pub(crate) summary: Summary,
    /// A row per frame.
    pub(crate) frames: Table,
    pub(crate) counted: Vec<Counted>,
}

/// Where the frames go that are not kept in memory.
pub(crate) struct Files<'a> {
    pub(crate) outputs: Recording<'a>,
    pub(crate) details: Details,
}

/// A run under way.
pub(crate) struct Run<'a> {
    design: &'a Design,
    network: &'a Network,
    player: Player<'a>,
    reference: Option<Reference<'a>>,
    costs: Option<Costs<'a>>,
    files: Files<'a>,
    sums: Vec<Positions>,
    traffic: Vec<Traffic>,
    clips: Vec<ClipSums>,
    /// Frames of the clips before this one, for the charts.
    before: u64,
    rows: Vec<Cells>,
    counted: Vec<Counted>,
    seconds: f64,
    overhead: f64,
    not_finite: NotFinite,
}

impl Audience for Run<'_> {
    fn begin(&mut self, clip: &str, black: Option<&[f32]>) {
        self.before = self.counted.last().map_or(0, |counted| counted.place + 1);
        self.clips.push(ClipSums::new(clip));
        self.player.begin(black);
        if let Some(reference) = &mut self.reference {
            reference.outputs.next_clip();
        }
    }

    fn look(&mut self, seen: Seen<'_>) -> Result<(), InferenceError> {
        let frame = self.step(seen);
        let clip = self.clips.last_mut().expect("a clip has begun");
        self.rows.push(frame.row(&clip.name, seen, self.costs.as_ref()));
        self.files.details.push(&clip.name, &frame, self.network, self.costs.as_ref())?;
        clip.add(&frame);
        if frame.is_counted {
            self.counted.push(Counted {
                place: self.before + frame.number,
                clip: clip.name.clone(),
                number: frame.number,
                name: seen.name.to_owned(),
                active: frame.active,
                changed: frame.changed,
                macs: frame.macs,
                seconds: frame.seconds,
                relative_rms: frame.relative_rms,
            });
        }
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
        reference: bool,
        costs: Option<Costs<'a>>,
        files: Files<'a>,
    ) -> Self {
        let network = player.network();
        Self {
            design,
            network,
            player,
            reference: reference.then(|| Reference::new(network)),
            costs,
            files,
            sums: vec![Positions::default(); network.nodes().len()],
            traffic: vec![Traffic::default(); network.nodes().len()],
            clips: Vec::new(),
            before: 0,
            rows: Vec::new(),
            counted: Vec::new(),
            seconds: 0.0,
            overhead: 0.0,
            not_finite: NotFinite::default(),
        }
    }

    /// Runs the network on a frame, and adds it to the sums if it counts.
    fn step(&mut self, seen: Seen<'_>) -> Frame {
        let start = Instant::now();
        let work = self.player.step(seen).to_vec();
        let seconds = start.elapsed().as_secs_f64();
        let (executor, is_counted) = (self.player.executor(), self.player.is_counted());
        let clip = &self.clips.last().expect("a clip has begun").name;
        self.not_finite.look((clip, seen.number), self.network, executor);
        let judge =
            |reference: &mut Reference<'_>| reference.judge(seen.values, executor, is_counted);
        let close = self.reference.as_mut().map(judge);
        let layers = Frame::layers(self.network, executor, &work, self.costs.as_ref());
        if is_counted {
            for (node, layer) in layers.iter().enumerate() {
                self.sums[node] += layer.positions;
                self.traffic[node] += layer.traffic;
            }
            if let Some(costs) = &mut self.costs {
                costs.add(layers.iter().filter_map(|layer| layer.cost));
            }
            self.seconds += seconds;
            self.overhead += executor.overhead().as_secs_f64();
        }
        let share = |count| ratio(count, u64::from(self.design.regions()));
        Frame {
            number: seen.number,
            is_counted,
            active: share(seen.active_regions),
            changed: share(seen.changed_regions),
            macs: Frame::macs(self.network, &layers),
            seconds,
            relative_rms: close.map(|close| close.distance.relative()),
            layers,
        }
    }

    /// Looks at a part of a clip.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub(crate) fn see(&mut self, part: Part<'_>) -> Result<(), InferenceError> {
        self.begin(part.clip, part.black);
        part.frames.iter().try_for_each(|kept| self.look(kept.seen()))
    }

    /// Clips whose frames are missing, with the reasons.
    pub(crate) fn problems(&self) -> Vec<(String, String)> {
        let of = |clip: &ClipSums| Some((clip.name.clone(), clip.problem.clone()?));
        self.clips.iter().filter_map(of).collect()
    }

    /// Whether a frame counted so far.
    pub(crate) fn counts(&self) -> bool {
        !self.counted.is_empty()
    }

    /// Clips so far.
    pub(crate) fn clips(&self) -> usize {
        self.clips.len()
    }

    /// What is to be written beside the files that grew.
    ///
    /// # Errors
    /// When these cannot be completed.
    pub(crate) fn end(self, told: Told) -> Result<Ended, InferenceError> {
        let executor = self.player.executor();
        let counted_frames = self.counted.len() as u64;
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
        let clips: Vec<_> = self.clips.iter().map(ClipSums::summary).collect();
        let forms = || (0..=self.network.nodes().len()).map(|value| self.network.form(value));
        #[allow(clippy::cast_precision_loss, reason = "a mean")]
        let counted = counted_frames.max(1) as f64;
        let mean = |of: fn(&Counted) -> f64| sum(self.counted.iter().map(of)) / counted;
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
            width: self.design.width(),
            height: self.design.height(),
            frames: self.rows.len() as u64,
            counted_frames,
            active_share: mean(|counted| counted.active),
            changed_share: mean(|counted| counted.changed),
            macs: macs(self.network, &self.sums),
            weight_bytes: layers.iter().map(|layer| layer.weight_bytes).sum(),
            kept_bytes: self.network.kept_bytes(),
            mask_bytes: forms().map(mask_bytes).sum(),
            traffic: all.mean(counted_frames),
            seconds_per_frame: self.seconds / counted,
            overhead_seconds_per_frame: self.overhead / counted,
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
            outputs: self.files.outputs.finish()?,
            clips,
            design: self.design.fingerprint(),
            configuration: self.design.config(),
            layers,
        };
        Ok(Ended { summary, frames: Table::of(self.rows.into_iter()), counted: self.counted })
    }
}
