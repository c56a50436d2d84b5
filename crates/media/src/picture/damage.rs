// SPDX-License-Identifier: MIT OR Apache-2.0
//! The damage that a check finds in the bytes of an image.

/// The fault because of which the bytes are not a complete image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum PictureFault {
    /// The file ends before the image does. The text says what is missing.
    Truncated(String),
    /// The image has bytes that its format does not allow. The text says which.
    Damaged(String),
}

impl PictureFault {
    pub(super) fn truncated(problem: impl Into<String>) -> Self {
        Self::Truncated(problem.into())
    }

    pub(super) fn damaged(problem: impl Into<String>) -> Self {
        Self::Damaged(problem.into())
    }
}

/// Fails with this damage unless the format's rule holds.
#[inline]
pub(super) fn require(holds: bool, problem: &str) -> Result<(), PictureFault> {
    if holds { Ok(()) } else { Err(PictureFault::damaged(problem)) }
}
