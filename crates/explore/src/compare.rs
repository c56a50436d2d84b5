// SPDX-License-Identifier: MIT OR Apache-2.0
//! A comparison of one camera with an ideal camera over one clip or data set, without a folder or a
//! Pareto front.

use std::path::PathBuf;

use foveate_camera::CameraConfig;
use foveate_fidelity::FidelityFigures;
use foveate_footage::{ComparedInput, InputOptions, open};

use crate::ExploreError;
use crate::measure::{CameraMeasurement, MeasuredClip};

/// The errors of a camera over a clip.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraComparison {
    /// The errors against the ideal camera.
    pub figures: FidelityFigures,
    /// The reason why the clip ended early, if it did.
    pub problem: Option<String>,
}

/// Compares the camera `config` with the ideal camera of `ideal`. `go_on` is called after every
/// frame; if it returns `false`, the comparison stops.
///
/// # Errors
/// Fails if the clip cannot be read, if a configuration is not valid for its frames, or if `go_on`
/// returns `false`.
pub fn compare(
    inputs: &[PathBuf],
    input: &InputOptions,
    config: &CameraConfig,
    ideal: &CameraConfig,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<CameraComparison, ExploreError> {
    let (width, height) = open(inputs, config, input)?.size();
    let camera = config.validate_for_frames(width, height)?;
    let subject = ComparedInput { name: String::new(), inputs: inputs.to_vec() };
    let whole = 0..u64::MAX;
    let clip = MeasuredClip {
        subject: &subject,
        input,
        ideal,
        parts: std::slice::from_ref(&whole),
        boxes: None,
        go_on,
    };
    let measured = clip.measure(&[camera])?.pop().and_then(|mut parts| parts.pop());
    let CameraMeasurement { tally, problem, .. } =
        measured.expect("one camera and one part are measured");
    Ok(CameraComparison { figures: tally.figures(), problem })
}
