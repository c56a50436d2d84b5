// SPDX-License-Identifier: MIT OR Apache-2.0
//! What can go wrong in a study. Every message names the thing and says what to do.

use std::path::PathBuf;

use foveate_design::ConfigError;
use foveate_engine::EngineError;
use foveate_footage::FootageError;
use foveate_footage::boxes::BoxError;
use foveate_pictures::chart::ChartError;
use foveate_staging::StagingError;
use thiserror::Error;

/// A study that cannot be started or finished; nothing is written then.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// An input cannot be read.
    #[error(transparent)]
    Footage(Box<FootageError>),
    /// A point of the study is not a valid design.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// The engine refused a frame.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// Images without order in a study of change.
    #[error(
        "`{name}` is a set of unrelated images, in which nothing changes; the study {study} needs clips"
    )]
    Set {
        /// The input.
        name: String,
        /// The study.
        study: &'static str,
    },
    /// The events of the sensor are missing.
    #[error(
        "the study `sensor` needs the events of a real sensor; name their file with --sensor-events"
    )]
    NoSensorEvents,
    /// The study is about one recording.
    #[error("the study `sensor` takes one clip, but {clips} are given")]
    OneClip {
        /// How many there are.
        clips: usize,
    },
    /// The events of the sensor cannot be read.
    #[error("cannot read sensor events `{}`: {problem}; expected CSV with the columns t_us, x, y, sorted by time", path.display())]
    SensorEvents {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// The recording is about another time than the clip.
    #[error(
        "no event of `{}` falls into the time of the clip, which is {first} to {last} us with \
         --sensor-start {first}. The events are from {from} to {to} us; set --sensor-start to the \
         time of the first frame on that clock",
        path.display()
    )]
    SensorTime {
        /// The file.
        path: PathBuf,
        /// Time of the first frame on the clock of the events, in microseconds.
        first: u64,
        /// That of the last.
        last: u64,
        /// Time of the first event.
        from: u64,
        /// That of the last.
        to: u64,
    },
    /// The boxes are missing.
    #[error(
        "the study `recall` needs ground-truth boxes of objects; name their file or folder with --boxes"
    )]
    NoBoxes,
    /// Boxes that cannot be read, or that do not fit the clips.
    #[error(transparent)]
    Boxes(#[from] BoxError),
    /// There is nothing to look for.
    #[error(
        "no object is to be counted in any frame after the first of `{clips}`; check --boxes, and take more \
         frames, or --images set for unrelated images"
    )]
    NoObjects {
        /// The clips.
        clips: String,
    },
    /// Charts cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
    /// The user stopped it.
    #[error("interrupted; nothing was written")]
    Cancelled,
}

impl From<FootageError> for StudyError {
    fn from(error: FootageError) -> Self {
        match error {
            FootageError::Interrupted => Self::Cancelled,
            error => Self::Footage(Box::new(error)),
        }
    }
}
