// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong in a simulation. Every message names the thing and says what to do.

use std::io;
use std::path::{Path, PathBuf};

use foveate_design::ConfigError;
use foveate_engine::EngineError;
use foveate_footage::FootageError;
use foveate_frame::FrameError;
use foveate_model::ModelError;
use foveate_packets::PacketError;
use foveate_staging::{StagedFolder, StagingError};
use foveate_toolchain::ToolError;
use thiserror::Error;

/// A simulation that cannot be started or finished.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SimulatorError {
    /// The footage cannot be opened or read.
    #[error(transparent)]
    Footage(FootageError),
    /// A clip of a batch without a result.
    #[error("none of the {clips} clips could be simulated; the first failed with: {first}")]
    NoClip {
        /// Number of clips.
        clips: usize,
        /// What was wrong with the first.
        first: String,
    },
    /// The output folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// Something cannot be written.
    #[error("cannot write `{}`: {source}; check free space and permissions, or choose another folder", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The system gave no thread.
    #[error("the system cannot start a thread: {reason}; try again with fewer programs running")]
    Thread {
        /// What it says.
        reason: String,
    },
    /// ffmpeg cannot be started.
    #[error(transparent)]
    Tool(Box<ToolError>),
    /// No video can be written on this machine.
    #[error("cannot write video: {0}; or write pictures instead, for example with --rendered png")]
    NoVideo(#[source] Box<ToolError>),
    /// A video could not be written to its end.
    #[error("ffmpeg cannot write `{}`: {problem}; check free space, or write pictures instead", path.display())]
    VideoOutput {
        /// The file.
        path: PathBuf,
        /// What ffmpeg said.
        problem: String,
        /// Whether there was no room.
        is_full: bool,
    },
    /// A contrast that would make events without end.
    #[error("a contrast of {contrast} is too small; it must be at least 0.01")]
    Contrast {
        /// The contrast as given.
        contrast: String,
    },
    /// A stream that would take more memory than its sender may ask for.
    #[error(
        "frame {frame} of the stream says that frames have {width}x{height} pixels, which are more than the {most} that a stream \
         alone may ask for; if that is right, give the camera's frame.width and frame.height in the configuration"
    )]
    ClaimedSize {
        /// Number of the frame.
        frame: u32,
        /// Frame width in the stream.
        width: u32,
        /// Frame height in the stream.
        height: u32,
        /// Most pixels.
        most: u32,
    },
    /// Pixel events are differences in time.
    #[error("images of a set have no order in time; pixel events need a clip")]
    PixelEventsOfSet,
    /// A data set needs a set of unrelated images.
    #[error(
        "{inputs} is a clip, but a data set is made of unrelated images: IDX or CIFAR files, or image files \
         with --images set; for a clip, use `foveate simulate`"
    )]
    NotASet {
        /// The inputs as given.
        inputs: String,
    },
    /// There is no such frame to explain.
    #[error("there is no frame {frame}; {inputs} has {frames} frames, counted from 0")]
    NoSuchFrame {
        /// The frame that was asked for.
        frame: u64,
        /// The inputs as given.
        inputs: String,
        /// How many there are.
        frames: u64,
    },
    /// There is no such region to explain.
    #[error("there is no region {x},{y}; columns are 0 to {}, rows 0 to {}", columns - 1, rows - 1)]
    NoSuchRegion {
        /// Column that was asked for.
        x: u32,
        /// Row that was asked for.
        y: u32,
        /// Columns of regions.
        columns: u32,
        /// Rows of regions.
        rows: u32,
    },
    /// The user stopped the run before its first frame was done.
    #[error("interrupted before the first frame was done; nothing was written")]
    Cancelled,
    /// The stream cannot be read as one of packets.
    #[error(transparent)]
    Packets(#[from] PacketError),
    /// A stream of packets ends with an error.
    #[error("cannot read `{stream}`: {source}")]
    ReadStream {
        /// What was read.
        stream: String,
        /// Why.
        source: io::Error,
    },
    /// An output that a stream of packets cannot give.
    #[error("a stream of packets gives no {output}: {why}")]
    NotInStream {
        /// What was asked for.
        output: &'static str,
        /// Why not.
        why: &'static str,
    },
    /// The configuration does not fit.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// The engine refused a frame.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// Pixels do not make a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// The model refused a frame.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl From<FootageError> for SimulatorError {
    fn from(error: FootageError) -> Self {
        match error {
            FootageError::Interrupted => Self::Cancelled,
            error => Self::Footage(error),
        }
    }
}

impl SimulatorError {
    /// Whether there was no room for an output.
    pub(crate) fn is_full(&self) -> bool {
        match self {
            Self::Write { source, .. } => foveate_staging::is_full(source),
            Self::Output(error) => error.is_full(),
            Self::VideoOutput { is_full, .. } => *is_full,
            _ => false,
        }
    }

    /// The file that cannot be written.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::Write { path, .. }
            | Self::VideoOutput { path, .. }
            | Self::Output(StagingError::Write { path, .. }) => Some(path),
            _ => None,
        }
    }

    /// As it is told: with paths in the folder of the output as the user will know them.
    #[must_use]
    pub fn named(self, staging: &StagedFolder) -> Self {
        match self {
            Self::Write { path, source } => Self::Write { path: staging.shown(&path), source },
            Self::Output(error) => Self::Output(staging.named(error)),
            Self::VideoOutput { path, problem, is_full } => {
                let problem = staging.shown_text(&problem);
                Self::VideoOutput { path: staging.shown(&path), problem, is_full }
            }
            other => other,
        }
    }
}
