// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong. Every message names the thing and says what to do.

use std::io;
use std::path::PathBuf;

use foveate_accelerator::AcceleratorError;
use foveate_design::ConfigError;
use foveate_engine::EngineError;
use foveate_files::npy::NpyError;
use foveate_footage::FootageError;
use foveate_footage::boxes::BoxError;
use foveate_network::NetworkError;
use foveate_network::sight::SightError;
use foveate_pictures::chart::ChartError;
use foveate_pictures::page::PageError;
use foveate_staging::StagingError;
use thiserror::Error;

/// A run that cannot be started or finished.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum InferenceError {
    /// The network cannot be read, or cannot be shown the frames.
    #[error(transparent)]
    Sight(#[from] SightError),
    /// The network cannot be read for arrays.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// An array cannot be read.
    #[error(transparent)]
    Array(#[from] NpyError),
    /// A file that was named cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// What was chosen does not exist.
    #[error("{problem}")]
    Choice {
        /// What was chosen, and what there is.
        problem: String,
    },
    /// An input cannot be read.
    #[error(transparent)]
    Footage(FootageError),
    /// Ground-truth boxes that cannot be read, or that do not fit the clips.
    #[error(transparent)]
    Boxes(#[from] BoxError),
    /// The configuration is not a valid design.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// The engine refused a frame.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// A chart cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// The page cannot be written.
    #[error(transparent)]
    Page(#[from] PageError),
    /// Pictures are wanted of outputs that are none.
    #[error(
        "no output is a picture, which has 1 or 3 channels and the height and width of the input: {outputs}; leave out png"
    )]
    NoPicture {
        /// The outputs with their shapes.
        outputs: String,
    },
    /// A table cannot be written.
    #[error("cannot write the table `{name}`: {source}")]
    Table {
        /// The file.
        name: String,
        /// Why.
        source: io::Error,
    },
    /// A layer cannot be mapped onto the accelerator.
    #[error("node `{node}` on the accelerator: {source}")]
    Accelerator {
        /// The node.
        node: String,
        /// Why.
        source: AcceleratorError,
    },
    /// The frames do not fit into memory together.
    #[error(
        "the pictures of the first {frames} frames take more than 4 GiB, and tuning keeps all in memory; cut the clip with --max-frames"
    )]
    TooLong {
        /// Frames that fit.
        frames: usize,
    },
    /// There are too few frames for two halves.
    #[error(
        "tuning takes one half of the frames and reports the other, for which it needs {least} frames; there {} {frames}",
        if *frames == 1 { "is" } else { "are" }
    )]
    TooShort {
        /// Frames that there are.
        frames: usize,
        /// Frames that would do.
        least: usize,
    },
    /// Clips without a frame that counts.
    #[error(
        "no frame of the {clips} counts, because a clip's first frame is computed whole; give clips of at least 2 frames"
    )]
    NothingCounts {
        /// Which clips.
        clips: &'static str,
    },
    /// Clips of different sizes.
    #[error(
        "all clips of a run must have one size, but `{first}` has {}x{} pixels and `{other}` has {}x{}; give --resize, or --crop",
        first_size.0, first_size.1, other_size.0, other_size.1
    )]
    Sizes {
        /// The first clip.
        first: String,
        /// Its width and height.
        first_size: (u32, u32),
        /// The first clip that differs.
        other: String,
        /// Its width and height.
        other_size: (u32, u32),
    },
    /// An input of several that cannot be opened a second time.
    #[error(
        "`{input}` can be read only once, so it must be the only input; record it to a file, or give it on its own"
    )]
    ReadOnce {
        /// The input.
        input: String,
    },
    /// The user stopped it before there was a result.
    #[error("interrupted; nothing was written")]
    Cancelled,
}

impl From<FootageError> for InferenceError {
    fn from(error: FootageError) -> Self {
        match error {
            FootageError::Interrupted => Self::Cancelled,
            error => Self::Footage(error),
        }
    }
}
