// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of the ideal camera.

use foveate_camera::ClassMapError;
use thiserror::Error;

/// An error of the ideal camera: a frame or a map that does not fit it.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum IdealError {
    /// The frame has another size or depth than the camera.
    #[error("the frame has {given}, but the camera takes {expected}; give it frames of that kind")]
    FrameFormat { given: String, expected: String },
    /// A map that does not fit the camera.
    #[error(transparent)]
    ClassMap(#[from] ClassMapError),
}
