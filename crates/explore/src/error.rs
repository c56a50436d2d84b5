// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of explorations. Every message names its subject and says what would be right.

use std::path::PathBuf;

use crate::link::LinkError;
use foveate_camera::ConfigError;
use foveate_cosim::EnergyError;
use foveate_estimate::{EstimateError, SiliconError};
use foveate_ideal::IdealError;
use foveate_inference::InferenceError;
use foveate_measure::FidelityError;
use foveate_media::PlaybackError;
use foveate_output::page::PageError;
use foveate_pixels::FrameError;
use foveate_tools::StagingError;
use thiserror::Error;

/// An error that keeps an exploration from starting or finishing.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum ExploreError {
    /// A frame cannot be made.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A frame could not be compressed.
    #[error("a frame cannot be compressed as JPEG: {reason}")]
    Jpeg { reason: String },
    /// The ideal camera is active too rarely for a limit on missed regions.
    #[error(
        "undecided: the ideal camera has {} active regions in the searched frames and {} in the frames that confirm, without the first frame of every clip, and --max-missed needs at least 49 in each; use more frames or other thresholds, or give --max-missed 100%",
        regions[0],
        regions[1]
    )]
    Undecided { regions: [f64; 2] },
    /// The file of the space is not valid.
    #[error("the space is not valid: {problem}")]
    Space { problem: String },
    /// A table of the file is not a valid design.
    #[error("the space, [{section}]: {error}")]
    InvalidSection { section: &'static str, error: ConfigError },
    /// No point of the space can be built.
    #[error("no valid design was found; tried {settings}: {reason}")]
    NoPoints { settings: String, reason: String },
    /// A network cannot be read, or cannot be run on the frames.
    #[error(transparent)]
    Inference(Box<InferenceError>),
    /// The task of a fit has zones, whose thresholds no search changes.
    #[error("a fit does not search the thresholds of zones; leave the table [zones] out")]
    Zones,
    /// A cost or a limit is a figure of a process, and there is none.
    #[error("{figure} is a figure of a process; give its cells with --liberty")]
    NoProcess { figure: &'static str },
    /// There are no objects, so no share of them can be sent.
    #[error(
        "the {half} half of the clips has no object to count, so --min-recall cannot be checked; \
         check --boxes, or use longer clips"
    )]
    NoObjects { half: &'static str },
    /// The folder exists and is not an exploration.
    #[error("`{}` exists but is not the folder of an exploration (it has no exploration.json); name another folder", path.display())]
    OtherFolder { path: PathBuf },
    /// The exploration has no unit of this name.
    #[error(
        "there is no unit `{unit}`: the space, the clips or the options have changed since it was planned; plan again"
    )]
    NoUnit { unit: String },
    /// A clip of a unit ended early.
    #[error("`{clip}` is not complete: {problem}")]
    IncompleteClip { clip: String, problem: String },
    /// A file of the exploration cannot be written or read.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Io { action: &'static str, path: PathBuf, source: std::io::Error },
    /// The clips cannot be played, or the user stopped the exploration; finished results are kept.
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    /// A design cannot be measured in front of the link of the space.
    #[error(transparent)]
    Link(Box<LinkError>),
    /// A configuration is not a valid design.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// The ideal camera refused a frame.
    #[error(transparent)]
    Ideal(#[from] IdealError),
    /// A design cannot be compared with the ideal camera.
    #[error(transparent)]
    Fidelity(#[from] FidelityError),
    /// The synthesis failed.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
    /// A design cannot be mapped to the cells of a process.
    #[error(transparent)]
    Silicon(Box<SiliconError>),
    /// The energy of a design cannot be measured.
    #[error(transparent)]
    Energy(Box<EnergyError>),
    /// A file or folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// The page cannot be written, which is a fault of the program.
    #[error(transparent)]
    Page(#[from] PageError),
}

impl ExploreError {
    pub(crate) fn io(
        action: &'static str,
        path: &std::path::Path,
    ) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Io { action, path, source }
    }
}

impl From<LinkError> for ExploreError {
    fn from(error: LinkError) -> Self {
        match error {
            LinkError::Playback(error) => Self::Playback(error),
            error => Self::Link(Box::new(error)),
        }
    }
}

impl From<InferenceError> for ExploreError {
    fn from(error: InferenceError) -> Self {
        Self::Inference(Box::new(error))
    }
}

impl From<SiliconError> for ExploreError {
    fn from(error: SiliconError) -> Self {
        Self::Silicon(Box::new(error))
    }
}

impl From<EnergyError> for ExploreError {
    fn from(error: EnergyError) -> Self {
        match error {
            EnergyError::Playback(error) => Self::Playback(error),
            error => Self::Energy(Box::new(error)),
        }
    }
}
