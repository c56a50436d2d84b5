// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of a limit for every node: a value must change by more than the limit to be passed
//! on. The outputs stay as close to those of a whole computation as the goal asks.
//!
//! A limit is the root mean square of a node's values in the first frame, multiplied by a power of
//! 2. First all nodes get the same power. The largest one that reaches the goal is halved, to leave
//! room for the next step: from front to back, each node's limit is doubled as long as the goal is
//! reached and fewer MACs are needed.

use super::clip_playback::ClipPart;
use super::computation::{Macs, PositionCounts, macs_of_layers};
use super::run::{ExecutorMode, NetworkRunner};
use crate::InferenceError;
use crate::closeness::{ClosenessTally, TuningGoal};
use crate::summary::{TuningSummary, TuningTrial};
use foveate_media::{PlaybackError, RunHooks, RunProgress};
use foveate_network::{ExecutionMode, Executor, Network};
use std::borrow::Cow;

/// The exponents of 2 of the multiples that all nodes get together.
const COMMON_POWERS: std::ops::RangeInclusive<i32> = -10..=1;
/// The largest number of times that a node's limit is doubled.
const MAX_DOUBLINGS: usize = 4;
/// The share of the needed MACs that a doubling must save.
const MIN_SAVING: f64 = 0.001;

/// The chosen limits, by node, and the summary of tuning.
pub(crate) struct TunedLimits {
    pub(crate) limits: Vec<f32>,
    pub(crate) tuning: TuningSummary,
}

/// The result of some limits.
#[derive(Clone, Debug)]
struct LimitTrial {
    limits: Vec<f32>,
    closeness: ClosenessTally,
    macs: Macs,
}

struct Tuner<'a> {
    network: &'a Network,
    goal: TuningGoal,
    parts: &'a [ClipPart<'a>],
    /// The outputs of a whole computation, by frame of all parts and by value.
    whole_outputs: Vec<Vec<Vec<f32>>>,
    runs: u64,
    /// The number of frames before the first run.
    frames_before: u64,
    hooks: &'a dyn RunHooks,
}

/// Tunes on parts of clips. The first frame of a part does not count, unless there is a black
/// screen to start from.
pub(crate) fn tune(
    network: &Network,
    goal: TuningGoal,
    parts: &[ClipPart<'_>],
    before: u64,
    hooks: &dyn RunHooks,
) -> Result<TunedLimits, InferenceError> {
    let (right, scales) = whole_outputs(network, parts);
    let mut tuner =
        Tuner { network, goal, parts, whole_outputs: right, runs: 0, frames_before: before, hooks };
    let exact = tuner.try_limits(vec![0.0; scales.len()])?;
    let together = |power: i32| scales.iter().map(|scale| scale * 2f32.powi(power)).collect();
    let mut uniform = Vec::new();
    for power in COMMON_POWERS {
        uniform.push((power, tuner.try_limits(together(power))?));
    }
    // A larger limit that reaches the goal after a smaller one missed it does so by chance, and
    // does not count.
    let holding =
        uniform.iter().take_while(|(_, trial)| goal.is_reached_by(&trial.closeness)).last();
    let best = holding.map_or(&exact, |(_, trial)| trial).clone();
    let start = match holding {
        Some((power, _)) => tuner.try_limits(together(power - 1))?,
        None => exact.clone(),
    };
    let least = 2f32.powi(*COMMON_POWERS.start());
    let own = tuner
        .double_limits(start, &scales.iter().map(|scale| scale * least).collect::<Vec<_>>())?;
    let frozen = tuner.try_limits(vec![f32::INFINITY; scales.len()])?;
    let chosen = if own.macs.needed < best.macs.needed { own } else { best };
    let tried = |trial: &LimitTrial, relative_limit| TuningTrial {
        relative_limit,
        needed_share: trial.macs.needed_share(),
        outputs: (&trial.closeness).into(),
        holds: goal.is_reached_by(&trial.closeness),
    };
    let tuning = TuningSummary {
        goal: goal.to_string(),
        clips: parts.iter().map(|part| part.clip.to_owned()).collect(),
        frames: chosen.closeness.frames,
        runs: tuner.runs,
        exact: tried(&exact, Some(0.0)),
        uniform: uniform
            .iter()
            .map(|(power, trial)| tried(trial, Some(2f64.powi(*power))))
            .collect(),
        chosen: tried(&chosen, None),
        frozen: tried(&frozen, None),
        holds: false,
    };
    Ok(TunedLimits { limits: chosen.limits, tuning })
}

/// Returns the outputs of all frames, and the root mean square of every node's values in the first
/// frame.
fn whole_outputs(network: &Network, parts: &[ClipPart<'_>]) -> (Vec<Vec<Vec<f32>>>, Vec<f32>) {
    let mut dense = Executor::new(network, ExecutionMode::Dense);
    let (mut right, mut scales) = (Vec::new(), Vec::new());
    for kept in parts.iter().flat_map(|part| part.frames) {
        let seen = kept.as_received();
        dense.step(seen.values, seen.changed);
        let nodes = 1..=network.nodes().len();
        if scales.is_empty() {
            scales = nodes
                .clone()
                .map(|value| root_mean_square(&dense.tensor(value).real_values()))
                .collect();
        }
        // The outputs are stored by value, so that they are found like those of an executor. Other
        // values are not needed.
        let outputs = network.outputs();
        let of = |value| {
            if outputs.contains(&value) {
                dense.tensor(value).real_values().to_vec()
            } else {
                Vec::new()
            }
        };
        right.push((0..=network.nodes().len()).map(of).collect());
    }
    (right, scales)
}

#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "a scale")]
fn root_mean_square(values: &[f32]) -> f32 {
    let sum: f64 = values.iter().map(|&value| f64::from(value) * f64::from(value)).sum();
    let root = (sum / values.len() as f64).sqrt() as f32;
    // A node with infinite or NaN values gets no limit.
    if root.is_finite() { root } else { 0.0 }
}

impl Tuner<'_> {
    /// Runs the network on all frames.
    fn try_limits(&mut self, limits: Vec<f32>) -> Result<LimitTrial, InferenceError> {
        let mut player = NetworkRunner::new(self.network, ExecutorMode::Limits(limits.clone()));
        let mut sums = vec![PositionCounts::default(); limits.len()];
        let mut closeness = ClosenessTally::default();
        let frames = self.parts.iter().flat_map(|part| {
            part.frames.iter().enumerate().map(move |(at, kept)| (part, at == 0, kept))
        });
        for (number, ((part, is_first, kept), right)) in (1..).zip(frames.zip(&self.whole_outputs))
        {
            if self.hooks.is_cancelled() {
                return Err(PlaybackError::Interrupted.into());
            }
            if is_first {
                closeness.next_clip();
                player.begin(part.black);
            }
            let work = player.step(kept.as_received()).to_vec();
            if player.is_counted() {
                for (node, (sums, work)) in sums.iter_mut().zip(&work).enumerate() {
                    *sums += PositionCounts::from_work(
                        work,
                        self.network.form(node + 1).position_count(),
                    );
                }
                closeness.add(&ClosenessTally::compare_outputs(
                    self.network,
                    |value| Cow::Borrowed(&right[value]),
                    player.executor(),
                ));
            }
            let done = self.frames_before + self.runs * self.whole_outputs.len() as u64 + number;
            self.hooks.progress(&RunProgress::frames(done, None, ""));
        }
        self.runs += 1;
        Ok(LimitTrial { limits, closeness, macs: macs_of_layers(self.network, &sums) })
    }

    /// Doubles the limits of one node after the other; limits that are 0 start at `least`.
    fn double_limits(
        &mut self,
        start: LimitTrial,
        least: &[f32],
    ) -> Result<LimitTrial, InferenceError> {
        let mut best = start;
        for (node, &least) in least.iter().enumerate() {
            for _ in 0..MAX_DOUBLINGS {
                let mut limits = best.limits.clone();
                limits[node] = (2.0 * limits[node]).max(least);
                let trial = self.try_limits(limits)?;
                if !self.goal.is_reached_by(&trial.closeness)
                    || trial.macs.needed > (1.0 - MIN_SAVING) * best.macs.needed
                {
                    break;
                }
                best = trial;
            }
        }
        Ok(best)
    }
}
