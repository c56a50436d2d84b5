// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a file of boxes says of an object in a frame.

use foveate_frame::Rect;

/// A box, and the track of its object if the file has tracks.
#[derive(Clone, Debug, PartialEq)]
pub struct Labelled {
    /// Where it is, in pixels of the frame before it is cropped and scaled.
    pub rect: Rect,
    /// The number of the object, the same in all frames.
    pub track: Option<u64>,
}
