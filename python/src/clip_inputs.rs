// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clips as Python passes them: footage by its name, or frames as arrays.

use std::ffi::CString;
use std::path::PathBuf;

use foveate_camera::CameraConfig;
use foveate_media::{
    ClipPlan, ClipPlayer, InputOptions, InputWarnings, SourceKind, plan, skipped_in_words,
    source_from_memory,
};
use foveate_pixels::ByteFrame;
use numpy::PyUntypedArrayMethods;
use pyo3::exceptions::{PyTypeError, PyUserWarning};
use pyo3::prelude::*;

use crate::array::untyped;
use crate::error::{raise, value_error};
use crate::frame::Grey;

/// The name of frames from arrays in results.
pub(crate) const ARRAY_NAME: &str = "array";

/// Returns inputs as paths: one, or a list of several.
pub(crate) fn paths(inputs: &Bound<'_, PyAny>) -> PyResult<Vec<PathBuf>> {
    if let Ok(path) = inputs.extract::<PathBuf>() {
        return Ok(vec![path]);
    }
    let kind = inputs.get_type().name()?;
    inputs.extract::<Vec<PathBuf>>().map_err(|_| {
        PyTypeError::new_err(format!(
            "inputs are a path, a pattern or scene:NAME, or a list of these, not {kind}"
        ))
    })
}

/// Warns of files and folders among the inputs that are not read although they might have been meant.
fn warn_of_skipped(py: Python<'_>, inputs: &[PathBuf], options: &InputOptions) -> PyResult<()> {
    for sentence in py.detach(|| skipped_in_words(inputs, options)) {
        let text = CString::new(sentence).unwrap_or_default();
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    Ok(())
}

/// Returns the error that ended a clip before its end, with the names of its inputs.
pub(crate) fn problem_text(player: &ClipPlayer) -> Option<String> {
    let problem = player.problem()?;
    Some(format!("{}: {problem}", player.inputs().join(", ")))
}

/// Warns of the error that ended a clip before its end, if there is one, and of what was found while
/// inputs were read.
pub(crate) fn warn_of_problem(py: Python<'_>, problem: Option<String>) -> PyResult<()> {
    for sentence in InputWarnings::of_process().take().into_iter().chain(problem) {
        let text = CString::new(sentence).unwrap_or_default();
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    Ok(())
}

/// The inputs of a function that takes footage or arrays.
pub(crate) enum ClipInputs {
    Paths(Vec<PathBuf>),
    Frames(Vec<ByteFrame>),
}

impl ClipInputs {
    /// Returns footage by its name, or frames from arrays for a design of some bits per pixel. `function` is named in
    /// messages.
    pub(crate) fn of(function: &str, inputs: &Bound<'_, PyAny>, bits: u32) -> PyResult<Self> {
        match paths(inputs) {
            // An empty list has no frames either.
            Ok(paths) if !paths.is_empty() => return Ok(Self::Paths(paths)),
            _ => {}
        }
        let wrong = |what: String| {
            PyTypeError::new_err(format!(
                "{function} takes footage, which is a path, a pattern, scene:NAME or a list of these, or frames, which \
                 are an array of shape (frames, height, width) or a list of arrays (height, width); not {what}"
            ))
        };
        let kind = inputs.get_type().name()?;
        // A sequence that NumPy does not know is converted to an array first.
        let is_clip = !inputs.hasattr("__iter__")? && inputs.hasattr("__dlpack__")?;
        let clip =
            is_clip.then(|| untyped(inputs, "a clip is an array of shape (frames, height, width)"));
        let clip = clip.transpose()?;
        let inputs = clip.as_ref().map_or(inputs, |clip| clip.as_any());
        let frames = inputs.try_iter().map_err(|_| wrong(kind.to_string()))?;
        let mut rasters: Vec<ByteFrame> = Vec::new();
        for frame in frames {
            let frame = frame?;
            let array = untyped(&frame, "a frame is a 2-D array of grey pixels (height, width)");
            let array = match array {
                Err(_) if !frame.hasattr("shape")? => {
                    return Err(wrong(format!("a {kind} of {}", frame.get_type().name()?)));
                }
                array => array?,
            };
            if array.ndim() != 2 {
                let what = format!("a {kind} of arrays of shape {}", array.getattr("shape")?);
                return Err(wrong(what));
            }
            rasters.push(Grey::of(&frame, bits)?.raster(bits)?);
        }
        Ok(Self::Frames(rasters))
    }

    /// Warns of files and folders that are not read although they might have been meant.
    pub(crate) fn warn_of_skipped(&self, py: Python<'_>, options: &InputOptions) -> PyResult<()> {
        match self {
            Self::Paths(paths) => warn_of_skipped(py, paths, options),
            Self::Frames(_) => Ok(()),
        }
    }

    /// Refuses inputs that are several clips.
    fn refuse_several(&self, options: &InputOptions) -> PyResult<()> {
        let Self::Paths(paths) = self else { return Ok(()) };
        match plan(paths, options).map_err(raise)? {
            ClipPlan::One => Ok(()),
            ClipPlan::Batch(clips) => Err(value_error(format!(
                "the inputs are {} clips; take them one after the other",
                clips.len()
            ))),
        }
    }

    /// Opens the inputs as a clip. A set of unrelated images is refused by `function`.
    pub(crate) fn open_clip(
        self,
        function: &str,
        camera: &CameraConfig,
        options: &InputOptions,
    ) -> PyResult<ClipPlayer> {
        let player = self.open(camera, options)?;
        match player.kind() {
            SourceKind::Clip => Ok(player),
            SourceKind::Set => Err(value_error(format!(
                "images of a set do not follow one another; {function} needs a clip"
            ))),
        }
    }

    /// Opens the inputs as one clip or set. Several clips are refused.
    pub(crate) fn open(
        self,
        camera: &CameraConfig,
        options: &InputOptions,
    ) -> PyResult<ClipPlayer> {
        self.refuse_several(options)?;
        match self {
            Self::Paths(paths) => ClipPlayer::open(&paths, camera, options).map_err(raise),
            Self::Frames(frames) => {
                Ok(source_from_memory(ARRAY_NAME, frames, options).map_err(raise)?.into())
            }
        }
    }
}
