// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sources of frames, and frames with their names and times.

pub(crate) mod feed;
pub(crate) mod file_feeds;
pub(crate) mod memory_source;
pub(crate) mod scaling;
pub(crate) mod selection;
pub(crate) mod set_form;
pub(crate) mod timestamped_feed;

use foveate_pixels::ByteFrame;

use crate::{CropRect, FootageError, FrameRate, LumaRange};
use set_form::SetForm;

/// A frame with its name and time.
#[derive(Clone, Debug)]
pub struct SourceFrame {
    /// The name of the file, or of the scene.
    pub name: String,
    /// The time since the first frame of the clip in microseconds.
    pub time_us: u64,
    /// The class of an image of a labelled set.
    pub label: Option<String>,
    /// The pixels.
    pub frame: ByteFrame,
}

/// The origin of a frame: its number and size in the input, before frames are selected, cropped and
/// scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameOrigin {
    /// The number among all frames of the input, counted from 0. After a seek it is right only with
    /// [`InputOptions::numbered`](crate::InputOptions::numbered).
    pub number: u64,
    /// The width and height before cropping and scaling.
    pub size: (u32, u32),
    /// True if the name of the frame is that of a file that holds only this frame.
    pub own_file: bool,
}

/// The relation between the frames of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceKind {
    /// The frames follow each other in time.
    Clip,
    /// The frames are independent: each is a first frame.
    Set,
}

impl SourceKind {
    /// Returns the time in microseconds of a frame that has none of its own: by the rate in a clip,
    /// zero in a set.
    pub(crate) fn time_us(self, rate: FrameRate, frame: u64) -> u64 {
        match self {
            Self::Clip => rate.time_us(frame),
            Self::Set => 0,
        }
    }
}

/// A source of frames of one size and depth, which come one at a time.
pub trait FrameSource: Send {
    /// Returns the width and height of every frame.
    fn size(&self) -> (u32, u32);

    /// Returns the inputs as the user named them, for the summary.
    fn inputs(&self) -> &[String];

    /// Returns the number of all frames, if it is known. For a video the number comes from the
    /// container, and may be wrong.
    fn frames(&self) -> Option<u64>;

    /// Returns the next frame, or `None` after the last.
    ///
    /// # Errors
    /// Fails if the frame cannot be read, or does not have the size of the others.
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, FootageError>;

    /// Takes back a frame that is no longer needed, to use its memory again.
    fn recycle(&mut self, _frame: SourceFrame) {}

    /// Returns the origin of the frame that was returned last. Returns `None` before the first
    /// frame, and for sources that do not know it.
    fn origin(&self) -> Option<FrameOrigin> {
        None
    }

    /// Returns the relation between the frames. In a set, every frame is a first frame.
    fn kind(&self) -> SourceKind {
        SourceKind::Clip
    }

    /// Returns the kind of the files and of the labels of a set.
    fn form(&self) -> SetForm {
        SetForm::default()
    }

    /// Returns the part of each frame that is kept, if the frames are cropped.
    fn crop(&self) -> Option<CropRect> {
        None
    }

    /// Returns the range of luma, if the input is video.
    fn luma(&self) -> Option<LumaRange> {
        None
    }

    /// After the last frame, returns the problem because of which the source ended too early. The
    /// frames before it are valid.
    fn problem(&self) -> Option<String> {
        None
    }
}
