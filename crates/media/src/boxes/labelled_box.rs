// SPDX-License-Identifier: MIT OR Apache-2.0
//! An object in a frame, as a box file describes it.

use foveate_pixels::Rect;

/// A box, and the track of its object if the file has tracks.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelledBox {
    /// The position of the object, in pixels of the frame before it is cropped and scaled.
    pub rect: Rect,
    /// The number of the object, which is the same in all frames.
    pub track: Option<u64>,
}

/// The boxes of an image, and its width and height, if the file states them.
#[derive(Debug, Default)]
pub(crate) struct ImageBoxes {
    pub(crate) size: Option<(u32, u32)>,
    pub(crate) boxes: Vec<LabelledBox>,
}
