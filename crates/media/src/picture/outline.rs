// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outline of an image in a file that may hold several.

/// The header of an image, and the bytes behind its end, if its end was found.
pub(super) struct ImageOutline<'a> {
    pub(super) header: &'a [u8],
    pub(super) after: Option<&'a [u8]>,
}
