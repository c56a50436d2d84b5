// SPDX-License-Identifier: MIT OR Apache-2.0
//! Damage that a reader finds in the bytes of an image.

/// Why the bytes of an image are not a whole image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum PictureFault {
    /// The file ends before the image does; the text says what is missing.
    Truncated(String),
    /// The image holds bytes that its format does not allow; the text says which.
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
