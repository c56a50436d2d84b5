// SPDX-License-Identifier: MIT OR Apache-2.0
//! The flips of a design by their source: how many fewer there are if only one thing is as in the
//! ideal camera of the task.

use foveate_camera::{Camera, CameraConfig, Neighborhood};
use serde::Serialize;

use crate::fit::{DecisionGroups, exact_fraction_bits, group_margin};
use crate::measure::CameraMeasurement;

/// The flips of a design that come from one source, as shares of the area from -1 to 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorSourceRow {
    /// `windows`, `filter`, `bits`, `thresholds`, `fraction bits`, `reference`, or `interaction`
    /// for the rest.
    pub source: &'static str,
    /// The flips of the design less those with only this one thing as in the task, so a negative
    /// share is an error that makes up for others; `None` if there is no such camera. For
    /// `interaction`, the flips of the design less all other rows.
    pub flips: Option<f64>,
    /// The share is between these two in 18 of 20 sets of as many other frames; `None` with fewer
    /// than two frames.
    pub interval: Option<[f64; 2]>,
    /// The reason why the flips or the interval are missing.
    pub reason: Option<String>,
}

/// A design, and the same design with one thing as in the task.
pub(crate) struct SourceVariants {
    /// The design, and those variants that differ from it.
    pub(crate) cameras: Vec<Camera>,
    /// The number of every source's camera, or the reason why there is none.
    sources: Vec<(&'static str, Result<usize, String>)>,
}

impl SourceVariants {
    pub(crate) fn new(design: &Camera, task: &Camera) -> Self {
        let (own, task) = (design.config(), task.config());
        let changed = |change: &dyn Fn(&mut CameraConfig)| {
            let mut config = own.clone();
            change(&mut config);
            Ok(config)
        };
        let fraction_bits = |config: &mut CameraConfig| {
            let side = config.region.size;
            let means = config.spatial.iter_mut().filter(|entry| entry.has_mean_fraction());
            means.for_each(|entry| entry.mean_fraction_bits = Some(exact_fraction_bits(side)));
        };
        let (bits, reference) = (task.frame.pixel_bits, task.temporal.reference);
        let variants = [
            // The windows of every ideal camera see the whole frame.
            ("windows", changed(&|own| own.region.neighborhood = Neighborhood::Shared)),
            ("filter", changed(&|own| own.denoise.filter = task.denoise.filter)),
            ("bits", Ok(own.scaled_to_depth(bits))),
            ("thresholds", with_thresholds_of(task, own)),
            ("fraction bits", changed(&fraction_bits)),
            ("reference", changed(&|own| own.temporal.reference = reference)),
        ];
        let mut cameras = vec![design.clone()];
        let sources = variants.map(|(source, config)| {
            let camera = config.and_then(|config| {
                config.validate().map_err(|error| format!("there is no such camera: {error}"))
            });
            let number = camera.map(|camera| {
                let is_new = camera != *design;
                cameras.extend(is_new.then_some(camera));
                if is_new { cameras.len() - 1 } else { 0 }
            });
            (source, number)
        });
        Self { sources: sources.into(), cameras }
    }

    /// Returns the rows from the measurements of all cameras over the same frames.
    pub(crate) fn rows(&self, measured: &[CameraMeasurement]) -> Vec<ErrorSourceRow> {
        let groups = measured.iter().map(|camera| DecisionGroups::from_frames(&camera.frames));
        let groups: Vec<DecisionGroups> = groups.collect();
        let flips = |camera: usize, left_out| groups[camera].total(left_out).flips();
        let fewer = |camera: usize, left_out| flips(0, left_out) - flips(camera, left_out);
        let rest = |left_out| {
            let cameras = self.sources.iter().filter_map(|(_, camera)| camera.as_ref().ok());
            flips(0, left_out) - cameras.map(|&camera| fewer(camera, left_out)).sum::<f64>()
        };
        let count = groups[0].0.len();
        let row = |source, share: &dyn Fn(Option<usize>) -> f64| {
            let flips = share(None);
            let margin = group_margin(count, |group| share(Some(group)));
            let ends = [flips - margin, flips + margin].map(|end| end.clamp(-1.0, 1.0));
            let (interval, reason) = match count {
                0 | 1 => (None, Some("an interval needs 2 frames or more".to_owned())),
                _ => (Some(ends), None),
            };
            ErrorSourceRow { source, flips: Some(flips), interval, reason }
        };
        let sources = self.sources.iter().map(|(source, camera)| match camera {
            Ok(camera) => row(source, &|left_out| fewer(*camera, left_out)),
            Err(reason) => {
                let reason = Some(reason.clone());
                ErrorSourceRow { source, flips: None, interval: None, reason }
            }
        });
        sources.chain([row("interaction", &rest)]).collect()
    }
}

/// Returns a camera with the thresholds of SRS and TRS of the task at its own depth, as if they
/// were not rounded: hits are whole numbers above a level, so a level that is rounded down has the
/// same ones. Fails with the reason if the task has no such thresholds.
fn with_thresholds_of(task: &CameraConfig, own: &CameraConfig) -> Result<CameraConfig, String> {
    let (side, bits) = (own.region.size, own.frame.pixel_bits);
    if task.region.size != side {
        let given = task.region.size;
        return Err(format!(
            "the thresholds of the task are for regions of {given}x{given} pixels; use a task with region.size = {side}"
        ));
    }
    let (mut config, scaled) = (own.clone(), task.scaled_to_depth(bits));
    for entry in &mut config.spatial {
        let feature = entry.feature;
        let mut entries = task.spatial.iter().zip(&scaled.spatial);
        let Some((given, scaled)) = entries.find(|(given, _)| given.feature == feature) else {
            return Err(format!(
                "the task has no thresholds for `{feature}`; use a task with this feature"
            ));
        };
        // Levels of a mean with fraction bits are compared in fractions of a grey level.
        let units = |level: Option<u32>| {
            u64::from(level.unwrap_or(0)) << entry.mean_fraction_bits.unwrap_or(0)
        };
        let fewer_bits = task.frame.pixel_bits.saturating_sub(bits);
        if fewer_bits > 0 && units(given.level) >> fewer_bits != units(scaled.level) {
            return Err(format!(
                "the task's level of `{feature}` is not a whole number at {bits} bits; use a task with a multiple of {}",
                1 << fewer_bits
            ));
        }
        (entry.level, entry.min_score) = (scaled.level, scaled.min_score);
    }
    config.temporal.level = scaled.temporal.level;
    config.temporal.min_count = scaled.temporal.min_count;
    Ok(config)
}
