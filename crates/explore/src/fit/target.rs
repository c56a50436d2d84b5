// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds for a wanted share of active regions.
//!
//! All thresholds in grey levels are scaled by one factor, as if the contrast of the scene were
//! scaled. This goes from nearly all regions to none in small steps. Then `temporal.min_count` is
//! set, because whole grey levels are too coarse for some shares.

use foveate_camera::{CameraConfig, Decimal, Neighborhood};
use foveate_design::DesignConfig;
use foveate_playback::ClipHalves;

use super::FitRequest;
use super::report::ActivityTarget;
use crate::ExploreError;
use crate::footage::ExplorationFootage;

/// The steps of the factor: quarters of a power of two, from 1/32 to 32.
const STEPS: std::ops::RangeInclusive<i32> = -20..=20;

/// Returns the task with thresholds for the wanted share, and the share that was found. Without a
/// wanted share it returns the task unchanged.
pub(super) fn task_for_target(
    request: &FitRequest<'_>,
    footage: &ExplorationFootage<'_>,
    halves: &ClipHalves,
) -> Result<(CameraConfig, Option<ActivityTarget>), ExploreError> {
    let DesignConfig { camera: own, hardware } = request.task;
    let Some(wanted) = request.target_active else { return Ok((own.clone(), None)) };
    let scaled = STEPS.map(|step| scale_thresholds(own, f64::from(step) / 4.0)).collect();
    let (task, _) = nearest_task(footage, halves, scaled, wanted)?;
    let n = task.region.size * task.region.size;
    let counts = (1..=n).filter(|count| *count <= 16 || count % (n / 16).max(1) == 0);
    let counted = counts.map(|count| {
        let mut config = task.clone();
        config.temporal.min_count = count;
        config
    });
    // The best task so far is also tried, so that the result cannot get worse.
    let all = std::iter::once(task.clone()).chain(counted).collect();
    let (task, found) = nearest_task(footage, halves, all, wanted)?;
    let whole = DesignConfig { camera: task.clone(), hardware: hardware.clone() };
    let target = ActivityTarget { wanted, found, task: whole.to_toml() };
    Ok((task, Some(target)))
}

/// Returns the task whose share of active regions on the first halves is nearest to the wanted one.
fn nearest_task(
    footage: &ExplorationFootage<'_>,
    halves: &ClipHalves,
    tasks: Vec<CameraConfig>,
    wanted: f64,
) -> Result<(CameraConfig, f64), ExploreError> {
    let (width, height) = footage.size;
    let camera = |task: &CameraConfig| {
        let mut exact = task.clone();
        exact.region.neighborhood = Neighborhood::Shared;
        exact.validate_for_frames(width, height)
    };
    // A scaled threshold can be out of range; such a task is left out.
    let (tasks, cameras): (Vec<CameraConfig>, Vec<_>) =
        tasks.into_iter().filter_map(|task| Some((task.clone(), camera(&task).ok()?))).unzip();
    let shares = footage.measure_first_halves(&cameras, &halves.frames, 0)?;
    let found = tasks.into_iter().zip(shares.iter().map(|(figures, _)| figures.active));
    let best = found
        .min_by(|(_, one), (_, other)| (one - wanted).abs().total_cmp(&(other - wanted).abs()));
    best.ok_or(ExploreError::NoPoints {
        settings: "every scale of the thresholds".to_owned(),
        reason: "none of them gives a valid design".to_owned(),
    })
}

/// Multiplies every threshold of the task in grey levels by `2^octaves`.
fn scale_thresholds(task: &CameraConfig, octaves: f64) -> CameraConfig {
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
    use std::path::PathBuf;

    use foveate_footage::InputOptions;
    use foveate_playback::SilentHooks;
    use foveate_toolchain::{Cache, Toolchain};

    use super::*;
    use crate::{Constraints, Synthesizer};

    #[test]
    fn thresholds_meet_the_wanted_share() {
        let share = |wanted: f64| {
            let request = FitRequest {
                task: &DesignConfig::from_toml("[frame]\nwidth = 64\nheight = 48\n").unwrap(),
                inputs: &[PathBuf::from("scene:street")],
                input: &InputOptions { frames: Some(16), ..InputOptions::default() },
                constraints: &Constraints::default(),
                clock_hz: None,
                target_active: Some(wanted),
                boxes: &[],
                network: None,
                synthesizer: &Synthesizer {
                    toolchain: Toolchain::system(),
                    cache: Cache::temporary().unwrap(),
                },
                max_designs: 1,
            };
            let footage = ExplorationFootage::new(
                (request.inputs, &[]),
                request.input,
                &request.task.camera,
                &SilentHooks,
            )
            .unwrap();
            let halves = ClipHalves { frames: vec![(8, 16)], ..ClipHalves::default() };
            let (task, target) = task_for_target(&request, &footage, &halves).unwrap();
            let target = target.unwrap();
            assert!((target.found - wanted).abs() < 0.05, "{wanted}: {}", target.found);
            let whole = DesignConfig { camera: task, ..request.task.clone() };
            assert_eq!(target.task, whole.to_toml());
            target.found
        };
        assert!(share(0.1) < share(0.25) && share(0.25) < share(0.6));
    }

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
