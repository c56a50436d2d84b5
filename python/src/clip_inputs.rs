// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clips as Python passes them: footage by its name, or frames as arrays.

use std::path::PathBuf;

use foveate_design::DesignConfig;
use foveate_footage::{InputOptions, source_from_memory};
use foveate_frame::ByteFrame;
use foveate_playback::{ClipPlayer, PlaybackError};
use numpy::PyUntypedArrayMethods;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

use crate::array::untyped;
use crate::footage::{paths, warn_of_skipped};
use crate::frame::Grey;

/// The name of frames from arrays in results.
pub(crate) const ARRAY_NAME: &str = "array";

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

    /// Opens the inputs as one clip or set.
    pub(crate) fn open(
        self,
        config: &DesignConfig,
        options: &InputOptions,
    ) -> Result<ClipPlayer, PlaybackError> {
        match self {
            Self::Paths(paths) => ClipPlayer::open(&paths, &config.camera, options),
            Self::Frames(frames) => Ok(source_from_memory(ARRAY_NAME, frames, options)?.into()),
        }
    }
}
