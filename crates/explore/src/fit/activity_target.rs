// SPDX-License-Identifier: MIT OR Apache-2.0
//! The thresholds for a wanted share of active regions.
//!
//! All thresholds in grey levels are scaled by one factor, as if the contrast of the scene were
//! scaled. This goes from nearly all regions to none in small steps. Then `temporal.min_count` is
//! set, because whole grey levels are too coarse for some shares.

use foveate_camera::{CameraConfig, Neighborhood};
use foveate_design::DesignConfig;
use foveate_media::ClipHalves;
use serde::Serialize;

use super::FitRequest;
use super::threshold_search::scale_thresholds;
use crate::ExploreError;
use crate::footage::ExplorationFootage;

/// The steps of the factor: quarters of a power of two, from 1/32 to 32.
const STEPS: std::ops::RangeInclusive<i32> = -20..=20;

/// The thresholds for a wanted share of active regions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ActivityTarget {
    /// The wanted share, 0..=1.
    pub wanted: f64,
    /// The nearest share that was possible, on the first half.
    pub found: f64,
    /// The task with these thresholds, as TOML.
    pub task: String,
}

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
    // The ideal camera has shared windows, whatever the windows of the task are.
    let camera = |task: &CameraConfig| {
        let mut exact = task.clone();
        exact.region.neighborhood = Neighborhood::Shared;
        exact.validate_for_frames(width, height)
    };
    // A scaled threshold can be out of range; such a task is left out.
    let (tasks, cameras): (Vec<CameraConfig>, Vec<_>) =
        tasks.into_iter().filter_map(|task| Some((task.clone(), camera(&task).ok()?))).unzip();
    let first_half = |clip: usize| std::iter::once(0..halves.frames[clip].0).collect();
    let measured = footage.measure_clip_parts(&cameras, first_half, 0)?;
    let shares = measured.iter().flatten().map(|half| half.tally.figures().active);
    let found = tasks.into_iter().zip(shares);
    let best = found
        .min_by(|(_, one), (_, other)| (one - wanted).abs().total_cmp(&(other - wanted).abs()));
    best.ok_or(ExploreError::NoPoints {
        settings: "every scale of the thresholds".to_owned(),
        reason: "none of them gives a valid design".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use foveate_media::{InputOptions, SilentHooks};
    use foveate_tools::{Cache, Toolchain};

    use super::*;
    use crate::{Constraints, CostObjective, Synthesizer};

    #[test]
    fn thresholds_meet_the_wanted_share() {
        let share = |wanted: f64| {
            let request = FitRequest {
                task: &DesignConfig::from_toml("[frame]\nwidth = 64\nheight = 48\n").unwrap(),
                inputs: &[PathBuf::from("scene:street")],
                input: &InputOptions { frames: Some(16), ..InputOptions::default() },
                constraints: &Constraints::default(),
                clock_hz: None,
                disturbance: None,
                target_active: Some(wanted),
                boxes: &[],
                cheapest: CostObjective::Area,
                process: None,
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
}
