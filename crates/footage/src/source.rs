// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sources of frames, and frames with their names and times.

pub(crate) mod ahead;
pub(crate) mod feed;
pub(crate) mod files;
pub(crate) mod form;
pub(crate) mod memory;
pub(crate) mod resize;
pub(crate) mod select;

use foveate_frame::Raster;

use crate::{FootageError, FrameRate};
use form::SetForm;

/// A frame with its name and time.
#[derive(Clone, Debug)]
pub struct SourceFrame {
    /// File name, or the name of the scene.
    pub name: String,
    /// Time since the first frame of the clip in microseconds.
    pub time_us: u64,
    /// The class of an image of a labelled set.
    pub label: Option<String>,
    /// The pixels.
    pub frame: Raster,
}

/// Where a frame was in its input, before any option took, cropped or scaled it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Its number among all frames of the input, from 0. After a sought start only with
    /// [`InputOptions::numbered`](crate::InputOptions::numbered).
    pub number: u64,
    /// Width and height.
    pub size: (u32, u32),
    /// Whether its name is that of a file of its own.
    pub own_file: bool,
}

/// How the frames of a source are related.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// They follow each other in time.
    Clip,
    /// They are unrelated: each is a first frame.
    Set,
}

impl Kind {
    /// The time of a frame without one of its own: by the rate in a clip, zero in a set.
    pub(crate) fn time_us(self, rate: FrameRate, frame: u64) -> u64 {
        match self {
            Self::Clip => rate.time_us(frame),
            Self::Set => 0,
        }
    }
}

/// Frames of one size and depth, one at a time.
pub trait Source: Send {
    /// Width and height of every frame.
    fn size(&self) -> (u32, u32);

    /// The inputs as the user named them, for the summary.
    fn inputs(&self) -> &[String];

    /// The number of all frames, if it is known. For a video it comes from the container, and may be
    /// wrong.
    fn frames(&self) -> Option<u64>;

    /// The next frame, or `None` after the last.
    ///
    /// # Errors
    /// When it cannot be read or does not have the size of the others.
    fn next_frame(&mut self) -> Result<Option<SourceFrame>, FootageError>;

    /// Takes back a frame that is no longer needed, to use its memory again.
    fn give_back(&mut self, _frame: SourceFrame) {}

    /// Where the frame that was given last was in its input; `None` where a source has no such place, and
    /// before the first frame.
    fn origin(&self) -> Option<Origin> {
        None
    }

    /// Whether frames follow each other in time. In a set, every frame is a first frame.
    fn kind(&self) -> Kind {
        Kind::Clip
    }

    /// For a set: the kind of its files, and its labels.
    fn form(&self) -> SetForm {
        SetForm::default()
    }

    /// After the last frame: why the source ended too early, if it did. The frames before are good.
    fn problem(&self) -> Option<String> {
        None
    }
}
