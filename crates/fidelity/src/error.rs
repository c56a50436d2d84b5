// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a comparison.

use thiserror::Error;

/// An error of a comparison: cameras or results that cannot be compared.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum FidelityError {
    /// The two cameras have frames of different sizes.
    #[error(
        "the ideal camera is for frames of {ideal} pixels, but the candidate is for {candidate}; \
         give both the same size"
    )]
    FrameSize {
        /// The width and height of the ideal camera's frames.
        ideal: String,
        /// The width and height of the candidate's frames.
        candidate: String,
    },
    /// The input has another size or depth than the ideal camera.
    #[error(
        "the input has {given}, but the ideal camera takes {expected}; give the frames that it saw"
    )]
    FrameFormat {
        /// The size and depth of the input.
        given: String,
        /// The size and depth of the ideal camera.
        expected: String,
    },
    /// The results belong to another camera.
    #[error(
        "{what}: {given} values were given, but the camera has {expected}; give the results of that camera"
    )]
    ResultLength {
        /// The camera and the results that do not fit, in words.
        what: &'static str,
        /// The number of values that were given.
        given: usize,
        /// The number of values that the camera needs.
        expected: usize,
    },
    /// The screen has pixels of the wrong type for the candidate's depth.
    #[error(
        "pixels of {bits} bits need the type {expected}, but the candidate's screen has {given}"
    )]
    PixelType {
        /// The number of bits per pixel of the candidate.
        bits: u32,
        /// The type that the candidate's pixels need.
        expected: &'static str,
        /// The type that was given.
        given: &'static str,
    },
}
