// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of a simulation. Every message names the input or output and says what to do.

use std::io;
use std::path::{Path, PathBuf};

use foveate_camera::ConfigError;
use foveate_media::{EventFileError, FootageError, PlaybackError};
use foveate_model::ModelError;
use foveate_output::chart::ChartError;
use foveate_packets::PacketError;
use foveate_pixels::FrameError;
use foveate_timed::TimedError;
use foveate_tools::{StagedFolder, StagingError, ToolError};
use thiserror::Error;

/// The error that is returned if a simulation cannot be started or finished.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum SimulatorError {
    /// The clip cannot be played, or the user stopped the run before its first frame was done.
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    /// The clocks of the frames cannot be computed.
    #[error(transparent)]
    Timed(#[from] TimedError),
    /// The events of pixels cannot be written in a format.
    #[error("{0}; write pixel events as npz or csv, or give other --resize or --rate")]
    PixelEvents(#[from] EventFileError),
    /// A chart cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// No clip of a batch has a result.
    #[error("none of the {clips} clips could be simulated; the first failed with: {first}")]
    NoClip { clips: usize, first: String },
    /// The output folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// A file or folder cannot be written.
    #[error("cannot write `{}`: {source}; check free space and permissions, or choose another folder", path.display())]
    Write { path: PathBuf, source: io::Error },
    /// The system cannot start a thread.
    #[error("the system cannot start a thread: {reason}; try again with fewer programs running")]
    Thread { reason: String },
    /// ffmpeg cannot be started.
    #[error(transparent)]
    Tool(Box<ToolError>),
    /// No video can be written on this machine.
    #[error("cannot write video: {0}; or write pictures instead, for example with --rendered png")]
    NoVideo(#[source] Box<ToolError>),
    /// A video could not be written to its end.
    #[error("ffmpeg cannot write `{}`: {problem}; check free space, or write pictures instead", path.display())]
    VideoOutput { path: PathBuf, problem: String, is_full: bool },
    /// The contrast is so small that it would give too many events.
    #[error("a contrast of {contrast} is too small; it must be at least 0.01")]
    Contrast { contrast: String },
    /// A stream claims a frame size that would need too much memory.
    #[error(
        "frame {frame} of the stream says that frames have {width}x{height} pixels, which are more than the {most} that a stream \
         alone may ask for; if that is right, give the camera's frame.width and frame.height in the configuration"
    )]
    ClaimedSize { frame: u32, width: u32, height: u32, most: u32 },
    /// Clocks are asked for from a set, whose images do not follow one another.
    #[error("images of a set do not follow one another; --clocks needs a clip")]
    ClocksOfSet,
    /// A table of stalls cannot be read.
    #[error("the stalls in `{}`: {problem}", path.display())]
    Stalls { path: PathBuf, problem: String },
    /// Pixel events are asked for from a set, whose images have no order in time.
    #[error("images of a set have no order in time; pixel events need a clip")]
    PixelEventsOfSet,
    /// A data set is asked for from a clip, whose frames are not independent images.
    #[error(
        "{inputs} is a clip, but a data set is made of unrelated images: IDX or CIFAR files, or image files \
         with --images set; for a clip, use `foveate simulate`"
    )]
    NotASet { inputs: String },
    /// The frame that is to be explained does not exist.
    #[error("there is no frame {frame}; {inputs} has {frames} frames, counted from 0")]
    NoSuchFrame { frame: u64, inputs: String, frames: u64 },
    /// The region that is to be explained does not exist.
    #[error("there is no region {x},{y}; columns are 0 to {}, rows 0 to {}", columns - 1, rows - 1)]
    NoSuchRegion { x: u32, y: u32, columns: u32, rows: u32 },
    /// The stream cannot be read as a stream of packets.
    #[error(transparent)]
    Packets(#[from] PacketError),
    /// Reading a stream of packets failed.
    #[error("cannot read `{stream}`: {source}")]
    ReadStream { stream: String, source: io::Error },
    /// The output cannot be made from a stream of packets.
    #[error("a stream of packets gives no {output}: {why}")]
    NotInStream { output: &'static str, why: &'static str },
    /// The configuration is not valid.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// Pixels do not make a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The model refused a frame.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl From<FootageError> for SimulatorError {
    fn from(error: FootageError) -> Self {
        PlaybackError::from(error).into()
    }
}

impl SimulatorError {
    /// Returns true if the disk was full.
    pub(crate) fn is_full(&self) -> bool {
        match self {
            Self::Write { source, .. } => foveate_tools::is_full(source),
            Self::Output(error) => error.is_full(),
            Self::VideoOutput { is_full, .. } => *is_full,
            _ => false,
        }
    }

    /// Returns the path of the file that cannot be written.
    pub(crate) fn unwritten_path(&self) -> Option<&Path> {
        match self {
            Self::Write { path, .. }
            | Self::VideoOutput { path, .. }
            | Self::Output(StagingError::Unwritable { path, .. }) => Some(path),
            _ => None,
        }
    }

    /// Replaces the paths of the staging folder by the paths that the user knows.
    #[must_use]
    pub fn with_shown_paths(self, staging: &StagedFolder) -> Self {
        match self {
            Self::Write { path, source } => Self::Write { path: staging.shown_path(&path), source },
            Self::Output(error) => Self::Output(staging.with_shown_path(error)),
            Self::VideoOutput { path, problem, is_full } => {
                let problem = staging.with_shown_paths(&problem);
                Self::VideoOutput { path: staging.shown_path(&path), problem, is_full }
            }
            other => other,
        }
    }
}
