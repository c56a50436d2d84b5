// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong. Every message names the thing and says what would be right.

use std::path::PathBuf;

use foveate_design::ConfigError;
use foveate_engine::EngineError;
use foveate_estimate::EstimateError;
use foveate_fidelity::FidelityError;
use foveate_footage::FootageError;
use foveate_footage::boxes::BoxError;
use foveate_ideal::IdealError;
use foveate_inference::InferenceError;
use foveate_pictures::page::PageError;
use foveate_staging::StagingError;
use thiserror::Error;

/// An exploration that cannot be started or finished.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExploreError {
    /// The file of the space is not valid.
    #[error("the space is not valid: {problem}")]
    Space {
        /// What is wrong.
        problem: String,
    },
    /// A part of the file is not a valid design.
    #[error("the space, [{section}]: {error}")]
    Section {
        /// The table of the file.
        section: &'static str,
        /// What is wrong.
        error: ConfigError,
    },
    /// No point of the space can be built.
    #[error("no valid design was found; tried {settings}: {reason}")]
    NoPoints {
        /// What was asked for.
        settings: String,
        /// Why it cannot be built.
        reason: String,
    },
    /// Clips of different sizes.
    #[error(
        "`{first}` has {first_size} pixels, but `{other}` has {other_size}; give all clips one size with --resize"
    )]
    Sizes {
        /// A clip.
        first: String,
        /// Its size.
        first_size: String,
        /// Another one.
        other: String,
        /// Its size.
        other_size: String,
    },
    /// A network cannot be read or shown frames.
    #[error(transparent)]
    Inference(Box<InferenceError>),
    /// Boxes that cannot be read, or that do not fit the clips.
    #[error(transparent)]
    Boxes(#[from] BoxError),
    /// There is nothing of which a share could be sent.
    #[error(
        "no object is to be counted in the {half} half of the clips, so --min-recall says nothing; check --boxes, \
         or take more footage"
    )]
    NoObjects {
        /// First or second.
        half: &'static str,
    },
    /// An input that can be read only once.
    #[error(
        "`{input}` can be read only once, but this command reads its inputs several times; record it to a file first"
    )]
    ReadOnce {
        /// The input.
        input: String,
    },
    /// A clip without enough frames.
    #[error("`{clip}` has {frames} frames; at least {least} are needed")]
    Short {
        /// The clip.
        clip: String,
        /// How many it has.
        frames: u64,
        /// How many are needed.
        least: u64,
    },
    /// A folder that holds something else.
    #[error("`{}` exists but is not the folder of an exploration (it has no exploration.json); name another folder", path.display())]
    Occupied {
        /// The folder.
        path: PathBuf,
    },
    /// A unit that the exploration does not have.
    #[error(
        "there is no unit `{unit}`: the space, the clips or the options are other than when it was planned; plan again"
    )]
    NoUnit {
        /// The name as given.
        unit: String,
    },
    /// A clip of a unit that ended before its end.
    #[error("`{clip}` is not complete: {problem}")]
    Broken {
        /// The clip.
        clip: String,
        /// Why it ended.
        problem: String,
    },
    /// A file of the exploration cannot be written or read.
    #[error("cannot {action} `{}`: {source}", path.display())]
    Io {
        /// What was tried.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// An input cannot be read.
    #[error(transparent)]
    Footage(Box<FootageError>),
    /// A configuration that is no design.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// The engine refused a frame.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The ideal camera refused a frame.
    #[error(transparent)]
    Ideal(#[from] IdealError),
    /// A design cannot be compared with the ideal.
    #[error(transparent)]
    Fidelity(#[from] FidelityError),
    /// The synthesis failed.
    #[error(transparent)]
    Estimate(#[from] EstimateError),
    /// A file or folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// The page cannot be written; this is a mistake of the program.
    #[error(transparent)]
    Page(#[from] PageError),
    /// The user stopped it; what was finished is kept.
    #[error("interrupted")]
    Cancelled,
}

impl From<FootageError> for ExploreError {
    fn from(error: FootageError) -> Self {
        match error {
            FootageError::Interrupted => Self::Cancelled,
            error => Self::Footage(Box::new(error)),
        }
    }
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

impl From<InferenceError> for ExploreError {
    fn from(error: InferenceError) -> Self {
        Self::Inference(Box::new(error))
    }
}
