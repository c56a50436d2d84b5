// SPDX-License-Identifier: MIT OR Apache-2.0
//! A comparison of one camera with an ideal camera over one clip or data set, without a folder or a
//! Pareto front.

use super::measure::{CameraMeasurement, MeasuredClip};
use crate::ExploreError;
use foveate_camera::CameraConfig;
use foveate_measure::FidelityFigures;
use foveate_media::{ClipPlayer, RunClips, RunHooks, RunMonitor};

/// The errors of a camera over a clip.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraComparison {
    /// The errors against the ideal camera.
    pub figures: FidelityFigures,
    /// The reason why the clip ended early, if it did.
    pub problem: Option<String>,
}

/// Compares the camera `config` with the ideal camera of `ideal` over the frames of a player, which
/// was opened for `ideal`.
///
/// # Errors
/// Fails if the clip cannot be read, if a configuration is not valid for its frames, or if `hooks`
/// cancels.
pub fn compare(
    player: ClipPlayer,
    config: &CameraConfig,
    ideal: &CameraConfig,
    hooks: &dyn RunHooks,
) -> Result<CameraComparison, ExploreError> {
    let (width, height) = player.size();
    let camera = config.validate_for_frames(width, height)?;
    let monitor = &RunMonitor::of_frames(hooks, player.frames());
    let clips = &RunClips::from_player(player, &[])?;
    let parts = std::slice::from_ref(&(0..u64::MAX));
    let clip = MeasuredClip { clips, clip: 0, ideal, parts, disturbance: None, monitor };
    let measured = clip.measure(&[camera])?.pop().and_then(|mut parts| parts.pop());
    let CameraMeasurement { tally, problem, .. } =
        measured.expect("one camera and one part are measured");
    Ok(CameraComparison { figures: tally.figures(), problem })
}
