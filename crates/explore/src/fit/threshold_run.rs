// SPDX-License-Identifier: MIT OR Apache-2.0
//! The run of a camera over the searched frames, and its best minima.

use foveate_camera::{Camera, CameraConfig, Decimal};
use foveate_engine::Engine;
use foveate_measure::{
    ChosenSteps, DecisionAreas, DecisionLimits, DecisionState, GridCells, MinimumSteps,
    ThresholdTable,
};
use foveate_media::FrameDepths;

use super::decision_rates::DecisionGroups;
use super::sampling_error::FRAME_GROUPS;
use super::search_frames::SearchFrame;
use crate::ExploreError;

/// The ratio of a number of pixels and the next smaller one that is tried.
const COUNT_RATIO: f64 = 1.15;
/// The octaves below and above a minimum score in grey levels that are tried, and the steps of an
/// octave.
const OCTAVES: i32 = 3;
const STEPS_OF_OCTAVE: i32 = 4;

/// A camera and its decisions so far.
pub(super) struct ThresholdRun {
    pub(super) camera: Camera,
    engine: Engine,
    decisions: RunDecisions,
    /// The share of the frames after which the run ended, because no minima can meet a limit.
    pub(super) ended_at: Option<f64>,
}

enum RunDecisions {
    /// Scores do not depend on decisions, so the decisions with all minima are known.
    OfAllMinima(ThresholdTable, MinimumDecimals),
    /// Only the decisions with the camera's minima are known, by groups of frames.
    OfOwnMinima(GridCells, Vec<DecisionAreas>),
}

/// The minima of a table, as they are written in a configuration.
struct MinimumDecimals {
    counts: Vec<u32>,
    scores: Vec<Vec<(u64, Decimal)>>,
}

impl ThresholdRun {
    pub(super) fn new(ideal: &Camera, camera: &Camera) -> Self {
        let decisions = match ThresholdTable::has_free_scores(camera.config()) {
            true => {
                let decimals = MinimumDecimals::around(camera);
                let table = ThresholdTable::new(ideal, camera, decimals.steps(), FRAME_GROUPS);
                RunDecisions::OfAllMinima(table, decimals)
            }
            false => RunDecisions::OfOwnMinima(
                GridCells::new(ideal, camera),
                vec![DecisionAreas::default(); FRAME_GROUPS],
            ),
        };
        Self { engine: Engine::new(camera), camera: camera.clone(), decisions, ended_at: None }
    }

    /// Shows a frame to the camera.
    pub(super) fn add_frame(
        &mut self,
        SearchFrame { ideal, order, group, .. }: &SearchFrame,
        depths: &FrameDepths<'_>,
    ) -> Result<(), ExploreError> {
        let outcome = depths.show_to(&mut self.engine)?;
        match &mut self.decisions {
            RunDecisions::OfAllMinima(table, _) => {
                table.add_frame(ideal, outcome, (*order, *group));
            }
            RunDecisions::OfOwnMinima(cells, groups) => {
                cells.for_each(|ideal_region, region, pixels| {
                    let (srs, trs) = (outcome.srs[region], outcome.trs[region]);
                    let own = DecisionState::new(srs, trs, outcome.actions[region]);
                    groups[*group].add_pair((ideal[ideal_region], own), pixels, *order);
                });
            }
        }
        Ok(())
    }

    /// Returns the least area that flips with any minima.
    pub(super) fn least_flips(&self) -> u64 {
        match &self.decisions {
            RunDecisions::OfAllMinima(table, _) => table.least_flips(),
            RunDecisions::OfOwnMinima(_, groups) => groups.iter().map(|group| group.action).sum(),
        }
    }

    /// Returns the cameras whose minima are nearest to some limits, at most `most`, with their
    /// decisions by groups of frames, and the number of cameras that were compared.
    pub(super) fn nearest(
        &self,
        limits: &DecisionLimits,
        most: usize,
    ) -> (Vec<(CameraConfig, DecisionGroups)>, usize) {
        let config = self.camera.config();
        match &self.decisions {
            RunDecisions::OfAllMinima(table, decimals) => {
                let start = decimals.steps_of(&self.camera);
                let (found, compared) = table.nearest(start, limits, most);
                let camera = |chosen: &ChosenSteps| {
                    let decisions = DecisionGroups(table.decisions(chosen));
                    (decimals.config(config, chosen), decisions)
                };
                (found.iter().map(|minima| camera(&minima.chosen)).collect(), compared)
            }
            RunDecisions::OfOwnMinima(_, groups) => {
                (vec![(config.clone(), DecisionGroups(groups.clone()))], 1)
            }
        }
    }
}

impl MinimumDecimals {
    /// Returns the minima around those of a camera.
    fn around(camera: &Camera) -> Self {
        let n = camera.region_pixels();
        let own = camera.temporal().min_count;
        let mut counts = rising_counts(n);
        counts.retain(|count| *count > 0 || own == 0);
        counts.push(own);
        counts.sort_unstable();
        counts.dedup();
        let entries = camera.config().spatial.iter().zip(camera.features());
        let scores = entries.map(|(entry, feature)| {
            let own = entry.min_score.expect("a camera has every key filled in");
            let measure = feature.kind().score_unit();
            let mut tried: Vec<Decimal> = match measure.is_count() {
                true => {
                    rising_counts(n).into_iter().map(|n| Decimal::from_whole(n.into())).collect()
                }
                false => {
                    let reach = OCTAVES * STEPS_OF_OCTAVE;
                    let octaves = |step: i32| {
                        f64::from(step * measure.scaling_exponent().cast_signed())
                            / f64::from(STEPS_OF_OCTAVE)
                    };
                    let at = |step| three_digits(as_f64(own) * octaves(step).exp2());
                    (-reach..=reach).filter_map(at).collect()
                }
            };
            tried.push(own);
            let as_score = |decimal: Decimal| {
                let score = u64::try_from(decimal.ceil_times(feature.unit())).ok()?;
                (score <= feature.score_max()).then_some((score, decimal))
            };
            let mut steps: Vec<_> = tried.into_iter().filter_map(as_score).collect();
            // The own minimum is kept where several are equal for the camera.
            steps.sort_by_key(|&(score, decimal)| (score, decimal != own));
            steps.dedup_by_key(|(score, _)| *score);
            steps
        });
        Self { scores: scores.collect(), counts }
    }

    fn steps(&self) -> MinimumSteps {
        let scores = |steps: &Vec<(u64, Decimal)>| steps.iter().map(|(score, _)| *score).collect();
        MinimumSteps {
            counts: self.counts.clone(),
            scores: self.scores.iter().map(scores).collect(),
        }
    }

    /// Returns the numbers of the steps of a camera's minima.
    fn steps_of(&self, camera: &Camera) -> ChosenSteps {
        let at_least = |found: Result<usize, usize>| found.unwrap_or_else(|next| next);
        let count = at_least(self.counts.binary_search(&camera.temporal().min_count));
        let scores = self.scores.iter().zip(camera.features());
        let scores = scores.map(|(steps, feature)| {
            at_least(steps.binary_search_by_key(&feature.min_score(), |(score, _)| *score))
        });
        std::iter::once(count).chain(scores).collect()
    }

    /// Returns the configuration with some of the minima.
    fn config(&self, config: &CameraConfig, chosen: &ChosenSteps) -> CameraConfig {
        let mut config = config.clone();
        config.temporal.min_count = self.counts[chosen[0]];
        for ((entry, steps), &step) in config.spatial.iter_mut().zip(&self.scores).zip(&chosen[1..])
        {
            entry.min_score = Some(steps[step].1);
        }
        config
    }
}

/// Returns rising numbers of pixels from 0 to `n`.
fn rising_counts(n: u32) -> Vec<u32> {
    let next = |count: &u32| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 2^16")]
        let next = (f64::from(*count) * COUNT_RATIO).round() as u32;
        Some(next.max(count + 1)).filter(|next| *next <= n)
    };
    std::iter::successors(Some(0), next).collect()
}

pub(super) fn three_digits(value: f64) -> Option<Decimal> {
    Decimal::from_f64(format!("{value:.2e}").parse().ok()?)
}

/// Returns the nearest floating-point number.
pub(super) fn as_f64(decimal: Decimal) -> f64 {
    decimal.to_string().parse().expect("a decimal is written as a number")
}
