// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of the models.

use foveate_camera::ClassMapError;
use thiserror::Error;

/// An error of a frame or a map that does not fit the design.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum ModelError {
    /// A frame whose size or depth differs from that of the design.
    #[error("the frame has {given}, but the design takes {expected}; give it frames of that kind")]
    FrameKind { given: String, expected: String },
    /// A map that does not fit the camera.
    #[error(transparent)]
    ClassMap(#[from] ClassMapError),
}
