// SPDX-License-Identifier: MIT OR Apache-2.0
//! The effect of disturbances on one design: its decisions and pixels on disturbed clips, against the ideal
//! camera on the clips as they are.

use std::path::PathBuf;

use foveate_camera::CameraConfig;
use foveate_footage::InputOptions;
use foveate_playback::RunHooks;
use serde::Serialize;

use crate::footage::ExplorationFootage;
use crate::measure::CameraMeasurement;
use crate::progress::measuring_progress;
use crate::row::{bytes_per_frame, count_to_f64};
use crate::{Disturbance, ExploreError};

/// The figures of a design on disturbed clips. Shares are 0..=1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DisturbanceRow {
    /// The disturbance, as `name=value`; `none` for the clips as they are.
    pub disturbance: String,
    /// The share of the regions whose action differs from the ideal's.
    pub flips: f64,
    /// The share of the ideal's active area that is not active in the design, without first frames; 0 without
    /// such an area.
    pub missed: f64,
    /// The share of the design's active area that is not active in the ideal, without first frames. If the ideal
    /// is never active, the share of the whole area.
    pub false_alarms: f64,
    /// The PSNR of the design's screen against the ideal's in dB; `None` if the screens are identical.
    pub psnr_ideal: Option<f64>,
    /// The bytes per frame that leave the camera.
    pub bytes_per_frame: f64,
}

/// Returns the figures of a camera without a disturbance and with each of the standard ones, over all frames of some
/// clips, and the reasons why clips ended early. `task` is the ideal camera.
///
/// # Errors
/// Fails if a clip cannot be read, if a configuration is not valid for its frames, or if `hooks` cancels.
pub fn disturb_design(
    (config, task): (&CameraConfig, &CameraConfig),
    inputs: &[PathBuf],
    input: &InputOptions,
    hooks: &dyn RunHooks,
) -> Result<(Vec<DisturbanceRow>, Vec<String>), ExploreError> {
    let mut footage = ExplorationFootage::new((inputs, &[]), input, task, hooks)?;
    let camera = config.validate_for_frames(footage.size.0, footage.size.1)?;
    let all = std::iter::once(None).chain(Disturbance::STANDARD.map(Some));
    let (mut rows, mut problems) = (Vec::new(), Vec::new());
    for (done, disturbance) in all.enumerate() {
        footage = footage.disturbed(disturbance);
        let stage = |_| measuring_progress(done, 1 + Disturbance::STANDARD.len());
        let mut sum = None;
        for (clip, subject) in footage.clips.clips().iter().enumerate() {
            let cameras = std::slice::from_ref(&camera);
            let whole = std::slice::from_ref(&(0..u64::MAX));
            let measured = footage.measure_parts(clip, cameras, whole, &stage)?;
            let measured = measured.into_iter().flatten().next();
            let problem = measured.as_ref().and_then(|measured| measured.problem.as_ref());
            if disturbance.is_none() {
                problems.extend(problem.map(|problem| format!("{}: {problem}", subject.name)));
            }
            CameraMeasurement::merge(&mut sum, measured);
        }
        let Some(CameraMeasurement { tally, .. }) = sum else { continue };
        let (figures, later) = (tally.figures(), tally.decisions().later);
        let share_of_all = count_to_f64(later.candidate) / count_to_f64(later.all.max(1));
        let false_alarms = if later.ideal == 0 { share_of_all } else { figures.false_alarms };
        rows.push(DisturbanceRow {
            disturbance: disturbance.map_or_else(|| "none".to_owned(), |own| own.to_string()),
            flips: figures.action_flips,
            missed: figures.missed,
            false_alarms,
            psnr_ideal: figures.psnr_ideal,
            bytes_per_frame: bytes_per_frame(&camera, &figures),
        });
    }
    Ok((rows, problems))
}
