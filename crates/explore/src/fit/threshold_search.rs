// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds with which a camera is nearest to the limits on its decisions
//! ([`ThresholdSearch`]). Thresholds cost no area, so every camera is judged with its best
//! ones.
//!
//! The levels of pixels are found by a descent: from some start, the search goes to the best of
//! the levels around it as long as that is better. For each set of levels the best minima
//! follow from one run over the frames ([`ThresholdRun`]), unless scores depend on decisions;
//! then minima are steps of the descent, too. A run ends early when no minima can meet the
//! limit on flips any more. All thresholds together are scaled as if the contrast of the scene
//! were ([`scale_thresholds`]).

use super::constraints::{ConstraintCheck, Constraints, all_met};
use super::decision_rates::{DecisionGroups, FRAME_GROUPS};
use super::search_frames::{SearchFrame, SearchFrames};
use crate::ExploreError;
use crate::row::count_to_f64;
use foveate_camera::{Camera, CameraConfig, Decimal};
use foveate_engine::Engine;
use foveate_measure::{
    ChosenSteps, DecisionAreas, DecisionLimits, DecisionState, GridCells, MinimumSteps,
    ThresholdTable,
};
use foveate_media::{FrameDepths, RunProgress};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// The number of runs over the frames at the same time.
const RUNS_AT_ONCE: usize = 32;
/// The relative changes of a level that are tried, besides changes by 1.
const LEVEL_CHANGES: [f64; 4] = [0.7, 0.88, 1.14, 1.4];
/// The shares of the frames after which a run ends if no minima can meet the limit on flips.
const EARLY_ENDS: [f64; 3] = [0.15, 0.3, 0.6];
/// The distance from the limits above which a camera is given up.
const HOPELESS: f64 = 4.0;
/// The distance up to which minima that send more are tried, if objects are counted.
const WELL_WITHIN: f64 = 0.6;
/// The number of minima of a run, and of thresholds of a camera, that are compared with a margin.
const MAX_ALTERNATIVES: usize = 8;

/// A camera with its best thresholds.
#[derive(Clone, Debug)]
pub(super) struct ThresholdChoice {
    pub(super) config: CameraConfig,
    /// The constraints on the rates to expect of other frames.
    pub(super) checks: Vec<ConstraintCheck>,
    /// The share of flips that no minima can be below, if the run ended early; it exceeds the
    /// limit, and there are no constraints.
    pub(super) least_flips: Option<f64>,
    /// The distance from the limits: the largest ratio of a rate and its limit.
    pub(super) distance: f64,
}

impl ThresholdChoice {
    pub(super) fn meets_limits(&self) -> bool {
        self.least_flips.is_none() && all_met(&self.checks)
    }
}

pub(super) struct ThresholdSearch<'a> {
    frames: &'a SearchFrames<'a>,
    constraints: &'a Constraints,
    limits: DecisionLimits,
    /// The number of cameras that were compared.
    pub(super) compared: usize,
}

/// The descent of one camera.
struct ThresholdDescent {
    /// The nearest thresholds, the best ones first.
    nearest: Vec<ThresholdChoice>,
    /// The cameras that are run next.
    next: Vec<CameraConfig>,
    /// The cameras that were run, without their minima if these are free.
    tried: BTreeSet<String>,
}

impl<'a> ThresholdSearch<'a> {
    pub(super) fn new(frames: &'a SearchFrames<'a>, constraints: &'a Constraints) -> Self {
        let &Constraints { max_flips, max_missed, max_false_alarms, .. } = constraints;
        let limits = DecisionLimits {
            flips: max_flips,
            missed: max_missed,
            false_alarms: max_false_alarms,
            // A camera that sends more regions can only send more objects.
            prefers_active_below: constraints.min_recall.map(|_| 1.0),
        };
        Self { frames, constraints, limits, compared: 0 }
    }

    /// Returns the nearest thresholds of each camera, the best ones first. Its descent begins at
    /// the best of some starts. The list is empty where no start is valid.
    pub(super) fn run(
        &mut self,
        starts: Vec<Vec<CameraConfig>>,
    ) -> Result<Vec<Vec<ThresholdChoice>>, ExploreError> {
        let begin = |next| ThresholdDescent { nearest: Vec::new(), next, tried: BTreeSet::new() };
        let mut descents: Vec<ThresholdDescent> = starts.into_iter().map(begin).collect();
        loop {
            let mut wanted = Vec::new();
            for (number, descent) in descents.iter_mut().enumerate() {
                for config in std::mem::take(&mut descent.next) {
                    if descent.tried.insert(run_key(&config))
                        && let Ok(camera) = config.validate()
                    {
                        wanted.push((number, camera));
                    }
                }
            }
            if wanted.is_empty() {
                return Ok(descents.into_iter().map(|descent| descent.nearest).collect());
            }
            let mut has_improved = vec![false; descents.len()];
            for some in wanted.chunks(RUNS_AT_ONCE) {
                let run = |(_, camera): &(_, _)| ThresholdRun::new(&self.frames.ideal, camera);
                let runs = self.run_cameras(some.iter().map(run).collect())?;
                let nearest: Vec<_> = runs.par_iter().map(|run| self.nearest(run)).collect();
                for (&(number, _), (nearest, compared)) in some.iter().zip(nearest) {
                    self.compared += compared;
                    has_improved[number] |= descents[number].add(nearest);
                }
            }
            for (descent, has_improved) in descents.iter_mut().zip(has_improved) {
                let best = descent.nearest.first();
                if let Some(best) = best.filter(|best| has_improved && best.distance < HOPELESS) {
                    descent.next = neighbor_cameras(&best.config);
                }
            }
        }
    }

    /// Returns the best minima with the levels of one camera.
    #[cfg(test)]
    pub(super) fn run_alone(&self, config: &CameraConfig) -> Result<ThresholdChoice, ExploreError> {
        let run = ThresholdRun::new(&self.frames.ideal, &config.validate()?);
        let runs = self.run_cameras(vec![run])?;
        Ok(self.nearest(&runs[0]).0.remove(0))
    }

    /// Runs cameras over the frames.
    fn run_cameras(&self, mut runs: Vec<ThresholdRun>) -> Result<Vec<ThresholdRun>, ExploreError> {
        let compared = self.compared;
        let progress = move || RunProgress::work(format!("comparing cameras, {compared} so far"));
        let mut ends = EARLY_ENDS.iter().peekable();
        self.frames.for_each(&progress, &mut |searched: &SearchFrame| {
            let depths = runs.iter().map(|run| run.camera.pixel_bits());
            let shown = searched.shown.as_ref();
            let depths = FrameDepths::from_disturbed(&searched.frame, shown, depths)?;
            let is_end = ends.next_if(|end| searched.seen >= **end).is_some();
            let running = runs.par_iter_mut().filter(|run| run.ended_at.is_none());
            running.try_for_each(|run| {
                run.add_frame(searched, &depths)?;
                let cannot = |limit| self.share_of_all(run.least_flips()) > limit;
                if is_end && self.limits.flips.is_some_and(cannot) {
                    run.ended_at = Some(searched.seen);
                }
                Ok::<_, ExploreError>(())
            })
        })?;
        Ok(runs)
    }

    fn share_of_all(&self, area: u64) -> f64 {
        count_to_f64(area) / count_to_f64(self.frames.areas[0].active.all.max(1))
    }

    /// Returns the nearest minima of a run, the best ones first, and the number of cameras that
    /// were compared.
    fn nearest(&self, run: &ThresholdRun) -> (Vec<ThresholdChoice>, usize) {
        let sides = (self.frames.ideal.region_size(), run.camera.region_size());
        let within = |bound| DecisionLimits { prefers_active_below: bound, ..self.limits };
        let (mut found, compared) = run.nearest(&within(None), MAX_ALTERNATIVES);
        if self.limits.prefers_active_below.is_some() {
            // The rates to expect of other frames are larger.
            found.extend(run.nearest(&within(Some(WELL_WITHIN)), MAX_ALTERNATIVES).0);
        }
        let judged = |(config, decisions): (CameraConfig, DecisionGroups)| {
            let rates = decisions.rates(sides);
            let all = [rates.flips, rates.missed, rates.false_alarms];
            let side = f64::from(sides.1);
            let active = rates.false_alarms.regions * side * side;
            let active = active / count_to_f64(self.frames.areas[0].later.all.max(1));
            if run.ended_at.is_none() {
                let distance = self.limits.distance(all.map(|rate| rate.expected), active);
                let checks = self.constraints.check_rates(&rates);
                return ThresholdChoice { config, checks, least_flips: None, distance };
            }
            // The other frames may have no flips. The distance is that of the frames so far.
            let least_flips = Some(self.share_of_all(run.least_flips()));
            let distance = self.limits.distance(all.map(|rate| rate.share), active);
            ThresholdChoice { config, checks: Vec::new(), least_flips, distance }
        };
        let mut nearest: Vec<ThresholdChoice> = found.into_iter().map(judged).collect();
        nearest.sort_by(|one, other| one.distance.total_cmp(&other.distance));
        nearest.dedup_by(|one, other| one.config == other.config);
        (nearest, compared)
    }
}

impl ThresholdDescent {
    /// Adds thresholds. Returns true if one is better than all before.
    fn add(&mut self, found: Vec<ThresholdChoice>) -> bool {
        let least = self.nearest.first().map_or(f64::INFINITY, |best| best.distance);
        self.nearest.extend(found);
        self.nearest.sort_by(|one, other| one.distance.total_cmp(&other.distance));
        self.nearest.truncate(MAX_ALTERNATIVES);
        self.nearest.first().is_some_and(|best| best.distance < least)
    }
}

/// Returns a text that is equal for cameras whose runs give the same table.
fn run_key(config: &CameraConfig) -> String {
    let mut config = config.clone();
    if ThresholdTable::has_free_scores(&config) {
        config.temporal.min_count = 0;
        config.spatial.iter_mut().for_each(|entry| entry.min_score = None);
    }
    config.to_toml()
}

/// Returns the cameras with one other level, and with one other minimum if scores depend on
/// decisions.
fn neighbor_cameras(config: &CameraConfig) -> Vec<CameraConfig> {
    let mut found = Vec::new();
    let mut with = |change: &dyn Fn(&mut CameraConfig)| {
        let mut other = config.clone();
        change(&mut other);
        found.push(other);
    };
    let level = config.temporal.level_or_default(config.frame.pixel_bits);
    levels_around(level)
        .iter()
        .for_each(|&level| with(&|config| config.temporal.level = Some(level)));
    let has_free_scores = ThresholdTable::has_free_scores(config);
    if !has_free_scores {
        for count in levels_around(config.temporal.min_count) {
            with(&|config| config.temporal.min_count = count);
        }
    }
    for (number, entry) in config.spatial.iter().enumerate() {
        for level in entry.level.map(levels_around).unwrap_or_default() {
            with(&|config| config.spatial[number].level = Some(level));
        }
        let Some(score) = entry.min_score.filter(|_| !has_free_scores) else { continue };
        let scores: Vec<Option<Decimal>> = match score.as_whole().map(u32::try_from) {
            Some(Ok(hits)) if entry.feature.score_unit().is_count() => levels_around(hits)
                .iter()
                .map(|&hits| Some(Decimal::from_whole(hits.into())))
                .collect(),
            _ => LEVEL_CHANGES.map(|change| three_digits(as_f64(score) * change)).to_vec(),
        };
        for score in scores.into_iter().flatten() {
            with(&|config| config.spatial[number].min_score = Some(score));
        }
    }
    found
}

fn levels_around(level: u32) -> Vec<u32> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
    let changed = LEVEL_CHANGES.map(|change| (f64::from(level) * change).round() as u32);
    let mut found = changed.to_vec();
    found.extend([level.saturating_sub(1), level + 1]);
    found.retain(|other| *other != level);
    found.sort_unstable();
    found.dedup();
    found
}

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

/// Multiplies every threshold of the task in grey levels by `2^octaves`.
pub(super) fn scale_thresholds(task: &CameraConfig, octaves: f64) -> CameraConfig {
    scale_thresholds_by(task, octaves, octaves)
}

/// Multiplies the thresholds of features by `2^spatial` and the temporal level by `2^temporal`.
pub(super) fn scale_thresholds_by(
    task: &CameraConfig,
    spatial: f64,
    temporal: f64,
) -> CameraConfig {
    let scale = |octaves: f64| move |level: u32| round_to_level(f64::from(level) * octaves.exp2());
    let (level, changed) = (scale(spatial), scale(temporal));
    let factor = spatial.exp2();
    let mut config = task.clone();
    let bits = task.frame.pixel_bits;
    config.temporal.level = Some(changed(config.temporal.level_or_default(bits)));
    for entry in &mut config.spatial {
        *entry = entry.with_defaults(bits);
        let measure = entry.feature.score_unit();
        entry.level = entry.level.map(level);
        if !measure.is_count() {
            // Deviations scale with the contrast, and their squares with its square.
            let factor = (0..measure.scaling_exponent()).map(|_| factor).product::<f64>();
            let scale = |score: Decimal| {
                let score: f64 = score.to_string().parse().expect("a decimal is a number");
                Decimal::from_f64((score * factor * 1000.0).round() / 1000.0)
            };
            entry.min_score = entry.min_score.and_then(scale);
        }
    }
    config
}

/// Returns the nearest whole number, within the range of a level.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
fn round_to_level(value: f64) -> u32 {
    value.round().clamp(0.0, f64::from(u32::MAX)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaling_is_of_grey_levels_and_of_their_squares() {
        let text = "[[spatial]]\nfeature = \"edge\"\n[[spatial]]\nfeature = \"mad\"\n[[spatial]]\nfeature = \"variance\"\n";
        let twice = scale_thresholds(&CameraConfig::from_toml(text).unwrap(), 1.0);
        assert_eq!((twice.temporal.level, twice.temporal.min_count), (Some(16), 5));
        assert_eq!(twice.spatial[0].level, Some(200));
        let scores: Vec<String> =
            twice.spatial.iter().map(|entry| entry.min_score.unwrap().to_string()).collect();
        assert_eq!(scores, ["5", "10", "200"]);
    }
}
