// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a comparison.

use thiserror::Error;

/// An error of a comparison: cameras or results that cannot be compared.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum FidelityError {
    /// The two cameras have frames of different sizes.
    #[error(
        "the ideal camera is for frames of {ideal} pixels, but the candidate is for {candidate}; \
         give both the same size"
    )]
    FrameSize { ideal: String, candidate: String },
    /// The input has another size or depth than the ideal camera.
    #[error(
        "the input has {given}, but the ideal camera takes {expected}; give the frames that it saw"
    )]
    FrameFormat { given: String, expected: String },
    /// The results belong to another camera.
    #[error(
        "{what}: {given} values were given, but the camera has {expected}; give the results of that camera"
    )]
    ResultLength { what: &'static str, given: usize, expected: usize },
    /// The screen has pixels of the wrong type for the candidate's depth.
    #[error(
        "pixels of {bits} bits need the type {expected}, but the candidate's screen has {given}"
    )]
    PixelType { bits: u32, expected: &'static str, given: &'static str },
}
