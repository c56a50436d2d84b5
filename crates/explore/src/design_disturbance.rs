// SPDX-License-Identifier: MIT OR Apache-2.0
//! The effect of disturbances on one design: its decisions and pixels on disturbed clips, against
//! the ideal camera on the clips as they are, and where its flips come from.

use std::path::PathBuf;

use foveate_camera::CameraConfig;
use foveate_media::{InputOptions, RunHooks};
use serde::Serialize;

use super::progress::measuring_progress;
use crate::error_source::SourceVariants;
use crate::footage::ExplorationFootage;
use crate::measure::CameraMeasurement;
use crate::row::{bytes_per_frame, count_to_f64};
use crate::{Disturbance, ErrorSourceRow, ExploreError};

/// The figures of a design on disturbed clips. Shares are 0..=1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DisturbanceRow {
    /// The disturbance, as `name=value`; `none` for the clips as they are.
    pub disturbance: String,
    /// The share of the regions whose action differs from the ideal's.
    pub flips: f64,
    /// The share of the ideal's active area that is not active in the design, without first frames;
    /// 0 without such an area.
    pub missed: f64,
    /// The share of the design's active area that is not active in the ideal, without first frames.
    /// If the ideal is never active, the share of the whole area.
    pub false_alarms: f64,
    /// The PSNR of the design's screen against the ideal's in dB; `None` if the screens are
    /// identical.
    pub psnr_ideal: Option<f64>,
    /// The bytes per frame that leave the camera.
    pub bytes_per_frame: f64,
}

/// A design on some clips.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DisturbedDesign {
    /// The figures without a disturbance, and then with each of the standard ones.
    pub rows: Vec<DisturbanceRow>,
    /// The sources of the flips without a disturbance, which add up to these flips.
    pub sources: Vec<ErrorSourceRow>,
    /// The reasons why clips ended early.
    pub problems: Vec<String>,
}

/// Measures a camera over all frames of some clips. `task` is the ideal camera.
///
/// # Errors
/// Fails if a clip cannot be read, if a configuration is not valid for its frames, or if `hooks`
/// cancels.
pub fn disturb_design(
    (config, task): (&CameraConfig, &CameraConfig),
    inputs: &[PathBuf],
    input: &InputOptions,
    hooks: &dyn RunHooks,
) -> Result<DisturbedDesign, ExploreError> {
    let mut footage = ExplorationFootage::new((inputs, &[]), input, task, hooks)?;
    let (width, height) = footage.size;
    let camera = config.validate_for_frames(width, height)?;
    let variants = SourceVariants::new(&camera, &task.validate_for_frames(width, height)?);
    let all = std::iter::once(None).chain(Disturbance::STANDARD.map(Some));
    let mut found = DisturbedDesign::default();
    for (done, disturbance) in all.enumerate() {
        footage = footage.disturbed(disturbance);
        let stage = |_| measuring_progress(done, 1 + Disturbance::STANDARD.len());
        // The sources are those of the clips as they are.
        let count = if disturbance.is_none() { variants.cameras.len() } else { 1 };
        let mut sums = vec![None; count];
        for (clip, subject) in footage.clips.clips().iter().enumerate() {
            let whole = std::slice::from_ref(&(0..u64::MAX));
            let cameras = &variants.cameras[..count];
            let measured = footage.measure_parts(clip, cameras, whole, &stage)?;
            let measured: Vec<CameraMeasurement> = measured.into_iter().flatten().collect();
            let problem = measured.first().and_then(|measured| measured.problem.as_ref());
            if disturbance.is_none() {
                let problem = problem.map(|problem| format!("{}: {problem}", subject.name));
                found.problems.extend(problem);
            }
            for (sum, measured) in sums.iter_mut().zip(measured) {
                CameraMeasurement::merge(sum, Some(measured));
            }
        }
        let sums: Vec<CameraMeasurement> = sums.into_iter().flatten().collect();
        let Some(CameraMeasurement { tally, .. }) = sums.first() else { continue };
        if disturbance.is_none() {
            found.sources = variants.rows(&sums);
        }
        let (figures, later) = (tally.figures(), tally.decisions().later);
        let share_of_all = count_to_f64(later.candidate) / count_to_f64(later.all.max(1));
        let false_alarms = if later.ideal == 0 { share_of_all } else { figures.false_alarms };
        found.rows.push(DisturbanceRow {
            disturbance: disturbance.map_or_else(|| "none".to_owned(), |own| own.to_string()),
            flips: figures.action_flips,
            missed: figures.missed,
            false_alarms,
            psnr_ideal: figures.psnr_ideal,
            bytes_per_frame: bytes_per_frame(&camera, &figures),
        });
    }
    Ok(found)
}
