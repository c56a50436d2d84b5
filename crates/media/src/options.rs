// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of inputs.

use std::path::PathBuf;

use foveate_tools::Interrupt;

use crate::bayer::BayerPattern;
use crate::limits::CropRect;
use crate::raw_layout::RawLayout;
use crate::source::selection::FrameSelection;
use crate::timestamps::TimestampsFile;
use crate::warnings::InputWarnings;
use crate::{FrameRate, LumaRange, Orientation};

/// The relation between image files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ImageRelation {
    /// The files are frames of one clip, in order.
    #[default]
    Clip,
    /// The files are a set, and each is a first frame. Sub-folders are searched, and their names
    /// are labels.
    Set,
    /// The files are CIFAR sheets with 1024 columns, and every row is an image of 32x32 pixels.
    CifarSheet,
}

/// The options by which inputs are read.
#[derive(Clone, Debug, Default)]
pub struct InputOptions {
    /// The largest number of frames. A scene has exactly this number.
    pub frames: Option<u32>,
    /// The frames per second of inputs without times: images, scenes, streams without a rate.
    pub frame_rate: FrameRate,
    /// The selection of frames of a clip.
    pub selection: FrameSelection,
    /// The part of every frame to take.
    pub crop: Option<CropRect>,
    /// The width and height to scale to, after cropping.
    pub resize: Option<(u32, u32)>,
    /// The range of the luma of video.
    pub luma: LumaRange,
    /// The layout of raw video. Every input is then a file or a pipe of raw video.
    pub raw: Option<RawLayout>,
    /// The mosaic of colours of images and of raw video.
    pub bayer: Option<BayerPattern>,
    /// The orientation in which images and video are taken.
    pub orientation: Orientation,
    /// The file with the times of the frames of images and of raw video.
    pub timestamps: Option<TimestampsFile>,
    /// The number of the video stream that is read, among those of a file, from 0. Without it, the
    /// stream that players take is read.
    pub video_stream: Option<usize>,
    /// The relation between image files.
    pub images: ImageRelation,
    /// The labels of an IDX file, if they are not beside it under their usual name.
    pub labels: Option<PathBuf>,
    /// True if the number of every frame must be known. A late start is then reached by decoding
    /// from the beginning, because a seek does not give the numbers of the skipped frames.
    pub numbered: bool,
    /// The request that ends every wait for frames with
    /// [`FootageError::Interrupted`](crate::FootageError::Interrupted).
    pub interrupt: Interrupt,
    /// The warnings that are found while frames are read.
    pub warnings: InputWarnings,
}
