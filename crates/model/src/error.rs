// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a model refuses.

use thiserror::Error;

/// A frame that does not belong to the design.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum ModelError {
    /// A frame of another size or depth than the design's.
    #[error("the frame has {given}, but the design takes {expected}; give it frames of that kind")]
    FrameKind {
        /// Size and depth of the frame.
        given: String,
        /// Size and depth of the design.
        expected: String,
    },
}
