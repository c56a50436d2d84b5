// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search over cameras: over every setting except those of the hardware.

use std::collections::BTreeMap;

use foveate_camera::{
    CameraConfig, ConfigError, Decimal, DenoiseFilter, FLOW_RADII, FeatureKind, Neighborhood,
    ReferencePolicy, ScoreUnit, SpatialConfig,
};
use foveate_design::HardwareConfig;
use foveate_measure::FidelityFigures;
use foveate_media::ClipHalves;

use super::constraints::{ConstraintCheck, Constraints, PartFigures, all_met, total_excess};
use super::decision_rates::{DecisionGroups, MIN_REGIONS};
use super::possible_designs::can_be_built;
use super::search_frames::{ClipPart, SearchFrames};
use super::threshold_search::{ThresholdChoice, ThresholdSearch};
use crate::ExploreError;
use crate::footage::ExplorationFootage;
use crate::measure::CameraMeasurement;
use crate::progress::measuring_progress;
use crate::row::{count_to_f64, sum_tallies};

/// The sides of regions that are tried besides the task's.
const SIDES: [u32; 3] = [4, 8, 16];
/// The fewest bits per pixel that are tried.
const FEWEST_BITS: u32 = 3;
/// The number of pairs of a region size and features that are examined closely, even if they flip
/// more than wanted.
const MIN_EXAMINED_PAIRS: usize = 3;
/// The distance from the limits up to which further pairs are examined.
const NEAR_DISTANCE: f64 = 1.5;
/// The number of nearest cameras that are examined if no camera meets the limits on its decisions.
const MAX_NEAREST_CAMERAS: usize = 6;

/// A camera and its figures on the first halves.
#[derive(Clone, Debug)]
pub(super) struct ExaminedCamera {
    pub(super) config: CameraConfig,
    pub(super) figures: FidelityFigures,
    /// The constraints, which must hold in the searched part and in the part that confirms.
    pub(super) checks: Vec<ConstraintCheck>,
}

/// A camera's figures on the second halves.
pub(super) struct SecondHalfResult {
    pub(super) figures: FidelityFigures,
    pub(super) checks: Vec<ConstraintCheck>,
    /// The clips that have fewer frames than at the start of the fit.
    pub(super) problems: Vec<String>,
}

/// The search and the cameras that it has examined.
pub(super) struct CameraSearch<'a> {
    constraints: &'a Constraints,
    footage: &'a ExplorationFootage<'a>,
    halves: &'a ClipHalves,
    task: CameraConfig,
    hardware: &'a HardwareConfig,
    examined: BTreeMap<String, ExaminedCamera>,
    /// The best thresholds of cameras, by what else they are.
    best: BTreeMap<String, ThresholdChoice>,
    compared: usize,
}

impl ExaminedCamera {
    pub(super) fn meets_limits(&self) -> bool {
        all_met(&self.checks)
    }

    /// Returns the distance of the camera from its limits, over all constraints.
    pub(super) fn excess(&self) -> f64 {
        total_excess(&self.checks)
    }
}

impl<'a> CameraSearch<'a> {
    pub(super) fn new(
        constraints: &'a Constraints,
        footage: &'a ExplorationFootage<'a>,
        halves: &'a ClipHalves,
        task: &CameraConfig,
        hardware: &'a HardwareConfig,
    ) -> Result<Self, ExploreError> {
        let (width, height) = footage.size;
        let task = task.validate_for_frames(width, height)?.config().clone();
        let (examined, best) = (BTreeMap::new(), BTreeMap::new());
        Ok(Self { constraints, footage, halves, task, hardware, examined, best, compared: 0 })
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &ExaminedCamera> {
        self.examined.values()
    }

    pub(super) fn best_thresholds(&self) -> impl Iterator<Item = &ThresholdChoice> {
        self.best.values()
    }

    /// Returns the number of cameras that were compared with the ideal.
    pub(super) fn compared(&self) -> usize {
        self.compared.max(self.examined.len())
    }

    /// Returns whether there is a limit on the screen or the sent bytes of a camera.
    pub(super) fn limits_figures(&self) -> bool {
        self.constraints.limits_figures()
    }

    pub(super) fn replace(&mut self, examined: ExaminedCamera) {
        self.examined.insert(examined.config.to_toml(), examined);
    }

    pub(super) fn get(&self, config: &CameraConfig) -> Option<&ExaminedCamera> {
        self.examined.get(&config.to_toml())
    }

    pub(super) fn with_best_thresholds(&self, config: &CameraConfig) -> Option<&ThresholdChoice> {
        self.best.get(&text_without_thresholds(config))
    }

    pub(super) fn task(&self) -> &CameraConfig {
        &self.task
    }

    /// Finds the best thresholds of each pair of a region size and features. Then it finds those of
    /// every cheaper version of the nearest pairs: other depths, windows, filters and references.
    /// It examines the cameras that meet the limits, or the nearest ones if none does.
    ///
    /// # Errors
    /// Fails if the ideal camera is active too rarely for a limit on missed regions.
    pub(super) fn run(&mut self) -> Result<(), ExploreError> {
        let frames = SearchFrames::read(self.footage, self.halves, &self.task.validate()?)?;
        self.check_active_regions(&frames)?;
        let mut search = ThresholdSearch::new(&frames, self.constraints);
        let features = self.features();
        let pairs = self.sides().into_iter();
        let pairs = pairs.flat_map(|side| features.iter().map(move |features| (side, features)));
        let starts = pairs.map(|(side, features)| {
            let mut starts = self.exact_cameras(side, features);
            starts.retain(|config| can_be_built(config, self.hardware));
            starts
        });
        let mut found = search.run(starts.collect())?;
        found.retain(|nearest| !nearest.is_empty());
        found.sort_by(|one, other| one[0].distance.total_cmp(&other[0].distance));
        let near = found.iter().filter(|nearest| nearest[0].distance <= NEAR_DISTANCE).count();
        let bases = found.iter().take(near.max(MIN_EXAMINED_PAIRS)).map(|nearest| &nearest[0]);
        let cheaper = bases.flat_map(|base| self.cheaper_cameras(&base.config));
        let cheaper = cheaper.filter(|config| can_be_built(config, self.hardware));
        found.extend(search.run(cheaper.map(|config| vec![config]).collect())?);
        self.compared = search.compared;
        found.retain(|nearest| !nearest.is_empty());
        found.sort_by(|one, other| one[0].distance.total_cmp(&other[0].distance));
        for nearest in &found {
            let key = text_without_thresholds(&nearest[0].config);
            self.best.entry(key).or_insert_with(|| nearest[0].clone());
        }
        self.examine_nearest(&found)
    }

    /// Examines the cameras that meet the limits on their decisions in the searched part, each with
    /// the best thresholds that meet all limits in both parts; or the nearest cameras if there is
    /// none.
    fn examine_nearest(&mut self, found: &[Vec<ThresholdChoice>]) -> Result<(), ExploreError> {
        let holding = found.iter().filter(|nearest| nearest[0].meets_limits()).count();
        let nearest = &found[..holding.max(MAX_NEAREST_CAMERAS).min(found.len())];
        let most = nearest.iter().map(Vec::len).max().unwrap_or(0);
        let mut open: Vec<&Vec<ThresholdChoice>> = nearest.iter().collect();
        for alternative in 0..most {
            let of_camera = |nearest: &&Vec<ThresholdChoice>| {
                let best = nearest.get(alternative)?;
                let is_worth_it = alternative == 0 || best.meets_limits();
                is_worth_it.then(|| best.config.clone())
            };
            let configs: Vec<_> = open.iter().filter_map(of_camera).collect();
            self.examine(&configs)?;
            open.retain(|nearest| {
                let config = nearest.get(alternative).map(|best| &best.config);
                let examined = config.and_then(|config| self.get(config));
                examined.is_some_and(|examined| !examined.meets_limits())
            });
        }
        Ok(())
    }

    /// Fails if the ideal camera is active too rarely for a limit on missed regions.
    fn check_active_regions(&self, frames: &SearchFrames<'_>) -> Result<(), ExploreError> {
        let side = f64::from(self.task.region.size);
        let regions = frames.areas.map(|areas| count_to_f64(areas.later.ideal) / (side * side));
        let is_limited = self.constraints.max_missed.is_some_and(|limit| limit < 1.0);
        if is_limited && regions.iter().any(|regions| *regions < MIN_REGIONS) {
            return Err(ExploreError::Undecided { regions: regions.map(f64::round) });
        }
        Ok(())
    }

    fn sides(&self) -> Vec<u32> {
        let own = self.task.region.size;
        std::iter::once(own).chain(SIDES.into_iter().filter(|&side| side != own)).collect()
    }

    /// Returns the task's features, and each feature alone.
    fn features(&self) -> Vec<Vec<SpatialConfig>> {
        let own = &self.task.spatial;
        let alone = FeatureKind::ALL.iter().map(|&kind| vec![SpatialConfig::new(kind)]);
        let is_own =
            |features: &Vec<SpatialConfig>| own.len() == 1 && own[0].feature == features[0].feature;
        std::iter::once(own.clone()).chain(alone.filter(|features| !is_own(features))).collect()
    }

    /// Returns cameras that are as exact as hardware can be, with every threshold worth trying.
    fn exact_cameras(&self, side: u32, features: &[SpatialConfig]) -> Vec<CameraConfig> {
        let mut exact = self.task.clone();
        exact.region.size = side;
        exact.region.neighborhood = Neighborhood::Shared;
        let counts = scaled_counts(self.task.temporal.min_count, self.task.region.size, side);
        let own = features == self.task.spatial;
        let choices: Vec<Vec<SpatialConfig>> = match features {
            [one] if !own => trial_thresholds(one.feature, self.task.frame.pixel_bits),
            _ => own_thresholds(features, self.task.region.size, side),
        };
        let mut found = Vec::new();
        for count in counts {
            for spatial in &choices {
                let mut config = exact.clone();
                config.temporal.min_count = count;
                config.spatial.clone_from(spatial);
                for entry in config.spatial.iter_mut().filter(|entry| entry.has_mean_fraction()) {
                    entry.mean_fraction_bits = Some(exact_fraction_bits(side));
                }
                found.push(config);
            }
        }
        found
    }

    /// Returns a camera with fewer bits, each neighborhood, each filter, each reference, and a mean
    /// with and without fraction bits, in all combinations.
    fn cheaper_cameras(&self, base: &CameraConfig) -> Vec<CameraConfig> {
        let mut found = Vec::new();
        let depth = base.frame.pixel_bits;
        for bits in (FEWEST_BITS.min(depth)..=depth).rev() {
            for &neighborhood in Neighborhood::ALL {
                for &filter in DenoiseFilter::ALL {
                    for &reference in ReferencePolicy::ALL {
                        let mut config = base.clone();
                        config.region.neighborhood = neighborhood;
                        config.denoise.filter = filter;
                        config.temporal.reference = reference;
                        found.push(config.scaled_to_depth(bits));
                    }
                }
            }
        }
        let coarse = found.clone().into_iter().filter_map(|mut config| {
            let means = config.spatial.iter_mut().filter(|entry| entry.has_mean_fraction());
            means.map(|entry| entry.mean_fraction_bits = Some(0)).count().gt(&0).then_some(config)
        });
        let coarse: Vec<CameraConfig> = coarse.collect();
        found.into_iter().chain(coarse).collect()
    }

    /// Examines cameras on the searched part of all clips and on the part that confirms. It leaves
    /// out invalid cameras.
    pub(super) fn examine(
        &mut self,
        configs: &[CameraConfig],
    ) -> Result<Vec<ExaminedCamera>, ExploreError> {
        let cameras: Vec<_> = configs.iter().filter_map(|config| config.validate().ok()).collect();
        let new: BTreeMap<String, _> = cameras
            .iter()
            .map(|camera| (camera.config().to_toml(), camera.clone()))
            .filter(|(text, _)| !self.examined.contains_key(text))
            .collect();
        let new_cameras: Vec<_> = new.values().cloned().collect();
        let parts = [ClipPart::Search, ClipPart::Confirmation];
        let measured = self.footage.measure_clip_parts(
            &new_cameras,
            |clip| parts.map(|part| part.frames(self.halves.frames[clip])).to_vec(),
            self.examined.len(),
        )?;
        for ((text, camera), measured) in new.iter().zip(measured) {
            let figures = sum_tallies(&measured.iter().collect::<Vec<_>>());
            let figures = figures.map(|tally| tally.figures());
            let figures = figures.ok_or(ConfigError::Syntax("no clip".to_owned()))?;
            let parts = measured.into_iter().map(|part| self.part_figures(part, "first"));
            let parts = parts.collect::<Result<Vec<_>, _>>()?;
            let checks = self.constraints.check_parts(camera, self.task.region.size, &parts);
            let config = camera.config().clone();
            self.examined.insert(text.clone(), ExaminedCamera { config, figures, checks });
        }
        Ok(cameras.iter().filter_map(|camera| self.get(camera.config()).cloned()).collect())
    }

    /// Returns the figures of a camera on the second halves, which influenced no choice. This is
    /// the last measurement of a fit, so it also finds the clips that have lost frames meanwhile.
    pub(super) fn measure_second_half(
        &self,
        examined: &ExaminedCamera,
    ) -> Result<SecondHalfResult, ExploreError> {
        let camera = examined.config.validate()?;
        let (mut sum, mut problems) = (None, Vec::new());
        for (clip, &(half, all)) in self.halves.frames.iter().enumerate() {
            let stage = |_| measuring_progress(0, 1);
            let cameras = std::slice::from_ref(&camera);
            let parts = self.footage.measure_parts(clip, cameras, &[0..half, half..all], &stage)?;
            let mut parts: Vec<_> = parts.into_iter().flatten().collect();
            let left = parts.iter().map(|part| part.tally.frames()).sum::<u64>();
            if left < all {
                let name = &self.footage.clips.clips()[clip].name;
                problems
                    .push(format!("{name}: it had {all} frames at first, and later only {left}"));
            }
            CameraMeasurement::merge(&mut sum, parts.pop());
        }
        let part = sum.ok_or(ConfigError::Syntax("no clip".to_owned()))?;
        let part = self.part_figures(part, "second")?;
        let checks = self.constraints.check_figures(&camera, &part);
        Ok(SecondHalfResult { figures: part.figures, checks, problems })
    }

    /// Returns the figures of a part of all clips.
    fn part_figures(
        &self,
        measured: CameraMeasurement,
        half: &'static str,
    ) -> Result<PartFigures, ExploreError> {
        let CameraMeasurement { tally, frames, objects, .. } = measured;
        let recall = match self.constraints.min_recall {
            Some(_) => Some(objects.recall().ok_or(ExploreError::NoObjects { half })?),
            None => None,
        };
        let decisions = DecisionGroups::from_frames(&frames);
        Ok(PartFigures { figures: tally.figures(), decisions, recall })
    }
}

/// Returns a text that is equal for cameras that differ in their thresholds only.
fn text_without_thresholds(config: &CameraConfig) -> String {
    let mut config = config.clone();
    (config.temporal.level, config.temporal.min_count) = (None, 0);
    for entry in &mut config.spatial {
        (entry.level, entry.min_score) = (None, None);
    }
    config.to_toml()
}

/// Scales a number of pixels of a region to another region size: unchanged, in proportion to the
/// area, and halfway between.
fn scaled_counts(count: u32, from: u32, to: u32) -> Vec<u32> {
    if count == 0 {
        return vec![0];
    }
    let n = to * to;
    let area = (u64::from(count) * u64::from(n)).div_ceil(u64::from(from * from));
    let area = u32::try_from(area).unwrap_or(n);
    let mut found = vec![count, area, u32::midpoint(count, area)];
    found.iter_mut().for_each(|count| *count = (*count).clamp(1, n));
    found.sort_unstable();
    found.dedup();
    found
}

/// Returns the task's features with their counts of hits scaled to another region size.
fn own_thresholds(features: &[SpatialConfig], from: u32, to: u32) -> Vec<Vec<SpatialConfig>> {
    let mut found: Vec<Vec<SpatialConfig>> = vec![Vec::new()];
    for entry in features {
        let hits =
            entry.min_score.and_then(Decimal::as_whole).and_then(|hits| hits.try_into().ok());
        let hits = hits.filter(|_| entry.feature.score_unit().is_count());
        let choices: Vec<SpatialConfig> = match hits {
            Some(hits) => scaled_counts(hits, from, to)
                .into_iter()
                .map(|hits| SpatialConfig {
                    min_score: Some(Decimal::from_whole(hits.into())),
                    ..entry.clone()
                })
                .collect(),
            None => vec![entry.clone()],
        };
        found = found
            .iter()
            .flat_map(|before| {
                choices
                    .iter()
                    .map(|choice| [before.as_slice(), std::slice::from_ref(choice)].concat())
            })
            .collect();
    }
    found
}

/// Returns the fraction bits with which the mean of a region is exact, or as exact as it can be:
/// ceil(log2 n).
pub(crate) fn exact_fraction_bits(side: u32) -> u32 {
    (side * side).next_power_of_two().ilog2()
}

/// Returns the thresholds to try for a feature that the task does not have. They are given for 8
/// bits and scaled to the depth.
fn trial_thresholds(feature: FeatureKind, bits: u32) -> Vec<Vec<SpatialConfig>> {
    let scaled =
        |spatial| CameraConfig { spatial, ..CameraConfig::default() }.scaled_to_depth(bits).spatial;
    trial_thresholds_of_8_bits(feature).into_iter().map(scaled).collect()
}

fn trial_thresholds_of_8_bits(feature: FeatureKind) -> Vec<Vec<SpatialConfig>> {
    const LEVELS: [u64; 10] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32];
    const HITS: [u64; 4] = [1, 2, 5, 10];
    let entry = |level: Option<u32>, radius: Option<u32>, min_score: u64| {
        vec![SpatialConfig {
            level,
            radius,
            min_score: Some(Decimal::from_whole(min_score)),
            ..SpatialConfig::new(feature)
        }]
    };
    let measure = feature.score_unit();
    let scores: Vec<u64> = match measure {
        ScoreUnit::Pixels => HITS.into(),
        ScoreUnit::Levels | ScoreUnit::SquaredLevels => {
            LEVELS.map(|level| level.pow(measure.scaling_exponent())).into()
        }
    };
    let levels: Vec<Option<u32>> =
        match feature.spec().level.as_ref().map_or(&[][..], |level| level.trial) {
            [] => vec![None],
            levels => levels.iter().copied().map(Some).collect(),
        };
    let radii: Vec<Option<u32>> =
        if feature.is_displacement() { FLOW_RADII.map(Some).collect() } else { vec![None] };
    let pairs = levels.iter().flat_map(|&level| radii.iter().map(move |&radius| (level, radius)));
    let of = |(level, radius)| scores.iter().map(move |&score| entry(level, radius, score));
    pairs.flat_map(of).collect()
}

#[cfg(test)]
mod tests {
    use foveate_media::{InputOptions, RunMonitor, SilentHooks};

    use super::super::test_clip::{remove_frames, write_clip};
    use super::*;

    /// Each radius is tried with each minimum, and the other features have no radius.
    #[test]
    fn every_radius_of_flow_is_tried() {
        let tried = |feature| {
            let entries = trial_thresholds(feature, 8).concat();
            entries.into_iter().map(|entry| entry.radius).collect::<Vec<_>>()
        };
        let radii = tried(FeatureKind::Flow);
        let count = |radius| radii.iter().filter(|&&one| one == Some(radius)).count();
        assert_eq!([1, 2, 3].map(count), [radii.len() / 3; 3]);
        assert!(tried(FeatureKind::Mad).iter().all(Option::is_none));
    }

    /// A clip of 12 frames loses its second half while the fit runs.
    #[test]
    fn a_clip_that_has_lost_frames_is_a_problem() {
        let dir = tempfile::tempdir().unwrap();
        let inputs = ["whole", "shortened"].map(|name| dir.path().join(name));
        inputs.iter().for_each(|folder| write_clip(folder, 12));
        let task = CameraConfig::from_toml("[frame]\nwidth = 48\nheight = 32\n").unwrap();
        let (options, constraints) = (InputOptions::default(), Constraints::default());
        let footage =
            ExplorationFootage::new((&inputs, &[]), &options, &task, &SilentHooks).unwrap();
        let monitor = RunMonitor::of_frames(&SilentHooks, None);
        let halves = ClipHalves::count(&footage.clips, 4, &monitor).unwrap();
        let hardware = HardwareConfig::default();
        let mut search =
            CameraSearch::new(&constraints, &footage, &halves, &task, &hardware).unwrap();
        let chosen = search.examine(std::slice::from_ref(&task)).unwrap().remove(0);
        let second = search.measure_second_half(&chosen).unwrap();
        assert_eq!((second.figures.frames, second.problems), (12, Vec::new()));
        remove_frames(&inputs[1], 6..12);
        let second = search.measure_second_half(&chosen).unwrap();
        assert_eq!(second.figures.frames, 6);
        assert_eq!(second.problems, ["shortened: it had 12 frames at first, and later only 6"]);
    }

    /// The levels of 4 bits that the task's round to are not the best ones: with them no minima
    /// meet the limits. The search is as near to the limits as all cameras of a grid.
    #[test]
    fn thresholds_are_chosen_anew_for_a_depth() {
        let dir = tempfile::tempdir().unwrap();
        let inputs = [dir.path().join("clip")];
        write_clip(&inputs[0], 60);
        let task = "[frame]\nwidth = 48\nheight = 32\n[temporal]\nlevel = 7\n";
        let task = CameraConfig::from_toml(task).unwrap();
        let options = InputOptions::default();
        let constraints = Constraints {
            max_flips: Some(0.02),
            max_missed: Some(0.1),
            max_false_alarms: Some(0.1),
            ..Constraints::default()
        };
        let footage =
            ExplorationFootage::new((&inputs, &[]), &options, &task, &SilentHooks).unwrap();
        let monitor = RunMonitor::of_frames(&SilentHooks, None);
        let halves = ClipHalves::count(&footage.clips, 6, &monitor).unwrap();
        let hardware = HardwareConfig::default();
        let search = CameraSearch::new(&constraints, &footage, &halves, &task, &hardware).unwrap();
        let ideal = search.task.validate().unwrap();
        let frames = SearchFrames::read(&footage, &halves, &ideal).unwrap();
        let mut thresholds = ThresholdSearch::new(&frames, &constraints);
        let mut start = search.task.clone();
        start.region.neighborhood = Neighborhood::Shared;
        let start = start.scaled_to_depth(4);
        let best = thresholds.run(vec![vec![start.clone()]]).unwrap().remove(0).remove(0);
        let mut least = f64::INFINITY;
        for level in 0..3 {
            for edge in 2..12 {
                let mut config = start.clone();
                config.temporal.level = Some(level);
                config.spatial[0].level = Some(edge);
                let alone = thresholds.run_alone(&config).unwrap();
                if config == start {
                    assert!(alone.distance > best.distance, "the start is not the best one");
                }
                least = least.min(alone.distance);
            }
        }
        assert!(best.distance <= least, "{} {least}", best.distance);
        assert!(best.meets_limits(), "{:?}", best.checks);
    }
}
