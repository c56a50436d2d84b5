// SPDX-License-Identifier: MIT OR Apache-2.0
//! One camera beside an ideal camera, over one clip or set: no folder, no front.

use std::path::PathBuf;

use foveate_camera::CameraConfig;
use foveate_fidelity::Figures;
use foveate_footage::{InputOptions, Subject, open};

use crate::ExploreError;
use crate::measure::{Clip, Measured};

/// The errors of a camera over a clip.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// The errors.
    pub figures: Figures,
    /// Why the clip ended before its end, if it did.
    pub problem: Option<String>,
}

/// Compares the camera `config` with the ideal camera of `ideal`. `go_on` is asked after every frame.
///
/// # Errors
/// When the clip cannot be read, a configuration is not valid for its frames, or `go_on` says no.
pub fn compare(
    inputs: &[PathBuf],
    input: &InputOptions,
    config: &CameraConfig,
    ideal: &CameraConfig,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<Compared, ExploreError> {
    let (width, height) = open(inputs, config, input)?.size();
    let camera = config.for_frames(width, height)?;
    let subject = Subject { name: String::new(), inputs: inputs.to_vec() };
    let whole = 0..u64::MAX;
    let clip = Clip {
        subject: &subject,
        input,
        ideal,
        parts: std::slice::from_ref(&whole),
        boxes: None,
        go_on,
    };
    let measured = clip.measure(&[camera])?.pop().and_then(|mut parts| parts.pop());
    let Measured { tally, problem, .. } = measured.expect("one camera and one part are measured");
    Ok(Compared { figures: tally.figures(), problem })
}
