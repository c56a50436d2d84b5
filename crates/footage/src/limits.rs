// SPDX-License-Identifier: MIT OR Apache-2.0
//! Limits and parts of frames, which readers follow and errors name.

/// Largest width and height of an image, in pixels.
pub use foveate_camera::MAX_SIDE;

/// Largest file in GiB, and the most memory that decoding may take.
pub(crate) const MAX_FILE_GIB: u64 = 1;

/// A part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// Width and height.
    pub size: (u32, u32),
    /// Its left and upper pixel.
    pub at: (u32, u32),
}
