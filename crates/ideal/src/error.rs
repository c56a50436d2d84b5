// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the ideal camera refuses.

use thiserror::Error;

/// A frame that does not belong to the camera.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum IdealError {
    /// A frame of another size or depth than the camera's.
    #[error("the frame has {given}, but the camera takes {expected}; give it frames of that kind")]
    FrameKind {
        /// Size and depth of the frame.
        given: String,
        /// Size and depth of the camera.
        expected: String,
    },
}
