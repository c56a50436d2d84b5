// SPDX-License-Identifier: MIT OR Apache-2.0
//! The limits of frames and files, and the part of a frame that is cropped.

/// The largest width and height of an image in pixels.
pub use foveate_camera::MAX_SIDE;

/// The largest file in GiB, and the largest memory of a decoder in GiB.
pub(crate) const MAX_FILE_GIB: u64 = 1;

/// A part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CropRect {
    /// The width and height of the part.
    pub size: (u32, u32),
    /// The column and row of the part's upper left pixel.
    pub origin: (u32, u32),
}
