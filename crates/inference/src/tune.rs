// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of a limit for every node: a value must change by more than the limit to be passed
//! on. The outputs stay as close to those of a whole computation as the goal asks.
//!
//! Limits are multiples of the root mean square of a node's values in the first frame, by powers of
//! 2. First all nodes get the same multiple; the largest multiple that reaches the goal is halved,
//! to leave room. Then, from front to back, each node's limit is doubled as long as the goal is
//! reached and fewer MACs are needed.

use crate::InferenceError;
use crate::album::Part;
use crate::closeness::{Closeness, Goal};
use crate::macs::{Macs, macs};
use crate::player::{Player, Way};
use crate::positions::Positions;
use crate::summary::{Tried, Tuning};
use foveate_footage::{Hooks, Progress};
use foveate_network::{Executor, Mode, Network};
use std::borrow::Cow;

/// The exponents of 2 of the multiples that all nodes get together.
const POWERS: std::ops::RangeInclusive<i32> = -10..=1;
/// The most times that a node's limit is doubled.
const DOUBLINGS: usize = 4;
/// The share of the needed MACs that a doubling must save.
const WORTH: f64 = 0.001;

/// The chosen limits, by node, and the summary of tuning.
pub(crate) struct Tuned {
    pub(crate) limits: Vec<f32>,
    pub(crate) tuning: Tuning,
}

/// The result of some limits.
#[derive(Clone, Debug)]
struct Trial {
    limits: Vec<f32>,
    closeness: Closeness,
    macs: Macs,
}

struct Tuner<'a> {
    network: &'a Network,
    goal: Goal,
    parts: &'a [Part<'a>],
    /// The outputs of a whole computation, by frame of all parts and by value.
    right: Vec<Vec<Vec<f32>>>,
    runs: u64,
    /// The number of frames before the first run.
    before: u64,
    hooks: &'a mut dyn Hooks,
}

/// Tunes on parts of clips. The first frame of a part does not count, unless there is a black
/// screen to start from.
pub(crate) fn tune(
    network: &Network,
    goal: Goal,
    parts: &[Part<'_>],
    before: u64,
    hooks: &mut dyn Hooks,
) -> Result<Tuned, InferenceError> {
    let (right, scales) = whole(network, parts);
    let mut tuner = Tuner { network, goal, parts, right, runs: 0, before, hooks };
    let exact = tuner.run(vec![0.0; scales.len()])?;
    let together = |power: i32| scales.iter().map(|scale| scale * 2f32.powi(power)).collect();
    let mut uniform = Vec::new();
    for power in POWERS {
        uniform.push((power, tuner.run(together(power))?));
    }
    // A larger limit that reaches the goal after a smaller one missed it does so by chance, and
    // does not count.
    let holding = uniform.iter().take_while(|(_, trial)| goal.holds(&trial.closeness)).last();
    let best = holding.map_or(&exact, |(_, trial)| trial).clone();
    let start = match holding {
        Some((power, _)) => tuner.run(together(power - 1))?,
        None => exact.clone(),
    };
    let least = 2f32.powi(*POWERS.start());
    let own = tuner
        .front_to_back(start, &scales.iter().map(|scale| scale * least).collect::<Vec<_>>())?;
    let frozen = tuner.run(vec![f32::INFINITY; scales.len()])?;
    let chosen = if own.macs.needed < best.macs.needed { own } else { best };
    let tried = |trial: &Trial, relative_limit| Tried {
        relative_limit,
        needed_share: trial.macs.needed_share(),
        outputs: (&trial.closeness).into(),
        holds: goal.holds(&trial.closeness),
    };
    let tuning = Tuning {
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
    Ok(Tuned { limits: chosen.limits, tuning })
}

/// Returns the outputs of all frames, and the root mean square of every node's values in the first
/// frame.
fn whole(network: &Network, parts: &[Part<'_>]) -> (Vec<Vec<Vec<f32>>>, Vec<f32>) {
    let mut dense = Executor::new(network, Mode::Dense);
    let (mut right, mut scales) = (Vec::new(), Vec::new());
    for kept in parts.iter().flat_map(|part| part.frames) {
        let seen = kept.seen();
        dense.step(seen.values, seen.changed);
        let nodes = 1..=network.nodes().len();
        if scales.is_empty() {
            scales =
                nodes.clone().map(|value| root_mean_square(&dense.value(value).reals())).collect();
        }
        // The outputs are stored by value, so that they are found like those of an executor. Other
        // values are not needed.
        let outputs = network.outputs();
        let of = |value| {
            if outputs.contains(&value) { dense.value(value).reals().to_vec() } else { Vec::new() }
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
    fn run(&mut self, limits: Vec<f32>) -> Result<Trial, InferenceError> {
        let mut player = Player::new(self.network, Way::Limits(limits.clone()));
        let mut sums = vec![Positions::default(); limits.len()];
        let mut closeness = Closeness::default();
        let frames = self.parts.iter().flat_map(|part| {
            part.frames.iter().enumerate().map(move |(at, kept)| (part, at == 0, kept))
        });
        for (number, ((part, is_first, kept), right)) in (1..).zip(frames.zip(&self.right)) {
            if self.hooks.cancelled() {
                return Err(InferenceError::Cancelled);
            }
            if is_first {
                closeness.next_clip();
                player.begin(part.black);
            }
            let work = player.step(kept.seen()).to_vec();
            if player.is_counted() {
                for (node, (sums, work)) in sums.iter_mut().zip(&work).enumerate() {
                    *sums += Positions::of(work, self.network.form(node + 1).places());
                }
                closeness.add(&Closeness::of(
                    self.network,
                    |value| Cow::Borrowed(&right[value]),
                    player.executor(),
                ));
            }
            let done = self.before + self.runs * self.right.len() as u64 + number;
            self.hooks.progress(Progress { done, total: None });
        }
        self.runs += 1;
        Ok(Trial { limits, closeness, macs: macs(self.network, &sums) })
    }

    /// Doubles the limits of one node after the other; limits that are 0 start at `least`.
    fn front_to_back(&mut self, start: Trial, least: &[f32]) -> Result<Trial, InferenceError> {
        let mut best = start;
        for (node, &least) in least.iter().enumerate() {
            for _ in 0..DOUBLINGS {
                let mut limits = best.limits.clone();
                limits[node] = (2.0 * limits[node]).max(least);
                let trial = self.run(limits)?;
                if !self.goal.holds(&trial.closeness)
                    || trial.macs.needed > (1.0 - WORTH) * best.macs.needed
                {
                    break;
                }
                best = trial;
            }
        }
        Ok(best)
    }
}
