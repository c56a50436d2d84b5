// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a comparison refuses.

use thiserror::Error;

/// Designs or results that cannot be compared.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum FidelityError {
    /// Two cameras for frames of different sizes.
    #[error(
        "the ideal camera is for frames of {ideal} pixels, but the candidate is for {candidate}; \
         give both the same size"
    )]
    FrameSize {
        /// Width and height of the ideal camera.
        ideal: String,
        /// Width and height of the candidate.
        candidate: String,
    },
    /// An input of another size or depth than the ideal camera's.
    #[error(
        "the input has {given}, but the ideal camera takes {expected}; give the frames that it saw"
    )]
    FrameKind {
        /// Size and depth of the input.
        given: String,
        /// Size and depth of the ideal camera.
        expected: String,
    },
    /// Results of another camera.
    #[error(
        "{what}: {given} values were given, but the camera has {expected}; give the results of that camera"
    )]
    Length {
        /// Of which side, and which results.
        what: &'static str,
        /// Values that came.
        given: usize,
        /// Values that the camera needs.
        expected: usize,
    },
    /// A screen whose pixels are of the wrong type for the candidate's depth.
    #[error(
        "pixels of {bits} bits need the type {expected}, but the candidate's screen has {given}"
    )]
    LaneWidth {
        /// Bits per pixel of the candidate.
        bits: u32,
        /// The type they need.
        expected: &'static str,
        /// The type that came.
        given: &'static str,
    },
}
