// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of runs. Every message names its subject and says what to do.

use std::io;
use std::path::PathBuf;

use foveate_camera::ConfigError;
use foveate_media::PlaybackError;
use foveate_network::{NetworkError, accelerator::AcceleratorError, vision::VisionError};
use foveate_output::{chart::ChartError, npy::NpyError, page::PageError};
use foveate_tools::StagingError;
use thiserror::Error;

/// An error that keeps a run from starting or finishing.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum InferenceError {
    /// The network cannot be read, or cannot be run on the frames.
    #[error(transparent)]
    Sight(#[from] VisionError),
    /// The network cannot be read for arrays.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// An array cannot be read.
    #[error(transparent)]
    Array(#[from] NpyError),
    /// A file that the user named cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Read { path: PathBuf, source: io::Error },
    /// An option names something that does not exist or cannot be used.
    #[error("{problem}")]
    InvalidOption { problem: String },
    /// The clips cannot be played, or the user stopped the run before there was a result.
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    /// The configuration is not a valid design.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// The folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// A chart cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// The page cannot be written.
    #[error(transparent)]
    Page(#[from] PageError),
    /// Pictures of outputs are wanted, but no output can be shown as one.
    #[error(
        "no output is a picture, which has 1 or 3 channels and the height and width of the input: {outputs}; leave out png"
    )]
    NoPictureOutput { outputs: String },
    /// A table cannot be written.
    #[error("cannot write the table `{name}`: {source}")]
    Table { name: String, source: io::Error },
    /// A layer cannot be mapped onto the accelerator.
    #[error("node `{node}` on the accelerator: {source}")]
    Accelerator { node: String, source: AcceleratorError },
    /// The frames do not fit into memory together.
    #[error(
        "the pixels of the first {frames} frames take more than 4 GiB, and tuning keeps all of them in memory; cut the clip with --max-frames"
    )]
    TooLong { frames: usize },
    /// There are too few frames for two halves.
    #[error(
        "tuning uses one half of the frames and reports the other, for which it needs {least} frames, but there {} {frames}",
        if *frames == 1 { "is" } else { "are" }
    )]
    TooShort { frames: usize, least: usize },
    /// The clips have no counted frame.
    #[error(
        "no frame of the {clips} counts, because the first frame of a clip is computed whole; give clips of at least 2 frames"
    )]
    NoCountedFrame { clips: &'static str },
}
