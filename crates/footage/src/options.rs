// SPDX-License-Identifier: MIT OR Apache-2.0
//! How inputs are read: what a user may choose about them.

use std::path::PathBuf;

use foveate_toolchain::Interrupt;

use crate::FrameRate;
use crate::limits::Crop;
use crate::source::select::Selection;

/// How image files are related.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ImagesAs {
    /// Frames of one clip, in order.
    #[default]
    Clip,
    /// A set: each is a first frame. Sub-folders are searched, and their names are labels.
    Set,
    /// CIFAR sheets: 1024 columns, and every row is an image of 32x32 pixels.
    CifarSheet,
}

/// Choices on how inputs are read.
#[derive(Clone, Debug, Default)]
pub struct InputOptions {
    /// At most this many frames; a scene has exactly this many.
    pub frames: Option<u32>,
    /// Frames per second of inputs without times: images, scenes, streams without a rate.
    pub frame_rate: FrameRate,
    /// Which frames of a clip to take.
    pub selection: Selection,
    /// The part of every frame to take.
    pub crop: Option<Crop>,
    /// Width and height to scale to, after cropping.
    pub resize: Option<(u32, u32)>,
    /// How image files are related.
    pub images: ImagesAs,
    /// The labels of an IDX file, if they are not beside it under their usual name.
    pub labels: Option<PathBuf>,
    /// Whether the number of every frame must be known: then a late start is decoded to, not sought.
    pub numbered: bool,
    /// Ends every wait for frames with [`FootageError::Interrupted`](crate::FootageError::Interrupted).
    pub interrupt: Interrupt,
}
