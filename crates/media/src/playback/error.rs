// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of playback: the input is at fault, a tool failed, or the user stopped. Every message
//! names its subject and says what would be right.

use crate::FootageError;
use crate::boxes::BoxError;
use foveate_engine::EngineError;
use foveate_pixels::FrameError;
use foveate_tools::ToolError;
use thiserror::Error;

/// An error that keeps clips from being played to their end.
#[derive(Debug, Error)]
pub enum PlaybackError {
    /// The clips cannot be read, or cannot be shown to a camera.
    #[error(transparent)]
    Input(Box<InputError>),
    /// The tool ffmpeg is missing or has failed.
    #[error(transparent)]
    Tool(Box<ToolError>),
    /// The user stopped the run before there was a result to keep.
    #[error("interrupted; nothing was written")]
    Interrupted,
}

/// A fault of the clips, or of the files that belong to them.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum InputError {
    /// A clip cannot be opened or read.
    #[error(transparent)]
    Footage(#[from] FootageError),
    /// The ground-truth boxes cannot be read, or do not fit the clips.
    #[error(transparent)]
    Boxes(#[from] BoxError),
    /// A camera refused a frame.
    #[error(transparent)]
    RefusedFrame(#[from] EngineError),
    /// Pixels do not make a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The clips have different sizes.
    #[error(
        "all clips of a run must have one size, but `{first}` has {}x{} pixels and `{other}` has {}x{}; give --resize, or --crop",
        first_size.0, first_size.1, other_size.0, other_size.1
    )]
    DifferentSizes { first: String, first_size: (u32, u32), other: String, other_size: (u32, u32) },
    /// One of several inputs cannot be opened a second time.
    #[error(
        "`{input}` can be read only once, so it must be the only input; record it to a file, or give it on its own"
    )]
    ReadOnceAmongOthers { input: String },
    /// An input of a run that reads its clips several times can be read only once.
    #[error(
        "`{input}` can be read only once, but this command reads its inputs several times; record it to a file first"
    )]
    ReadOnce { input: String },
    /// A clip has too few frames.
    #[error("`{clip}` has {frames} frames; at least {least} are needed")]
    TooFewFrames { clip: String, frames: u64, least: u64 },
}

impl PlaybackError {
    /// Returns true if the user stopped the run.
    #[must_use]
    pub fn is_interrupted(&self) -> bool {
        match self {
            Self::Interrupted => true,
            Self::Input(_) | Self::Tool(_) => false,
        }
    }

    /// Returns the fault of the input, if it is one.
    #[must_use]
    pub fn as_input(&self) -> Option<&InputError> {
        match self {
            Self::Input(error) => Some(error),
            Self::Tool(_) | Self::Interrupted => None,
        }
    }
}

impl From<InputError> for PlaybackError {
    fn from(error: InputError) -> Self {
        match error {
            InputError::Footage(error) => error.into(),
            error => Self::Input(Box::new(error)),
        }
    }
}

impl From<FootageError> for PlaybackError {
    fn from(error: FootageError) -> Self {
        match error {
            FootageError::Interrupted => Self::Interrupted,
            FootageError::Tool(error) if error.is_interrupted() => Self::Interrupted,
            FootageError::Tool(error) => Self::Tool(error),
            error => Self::Input(Box::new(InputError::Footage(error))),
        }
    }
}

impl From<BoxError> for PlaybackError {
    fn from(error: BoxError) -> Self {
        InputError::from(error).into()
    }
}

impl From<EngineError> for PlaybackError {
    fn from(error: EngineError) -> Self {
        InputError::from(error).into()
    }
}

impl From<FrameError> for PlaybackError {
    fn from(error: FrameError) -> Self {
        InputError::from(error).into()
    }
}
