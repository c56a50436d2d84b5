// SPDX-License-Identifier: MIT OR Apache-2.0
//! The errors of studies. Every message names its subject and says what to do.

use std::path::PathBuf;

use foveate_camera::ConfigError;
use foveate_media::PlaybackError;
use foveate_output::chart::ChartError;
use foveate_tools::StagingError;
use thiserror::Error;

/// An error that keeps a study from starting or finishing; nothing is written then.
#[derive(Debug, Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "fields of variants are named in the messages")]
pub enum StudyError {
    /// The clips cannot be played, or the user stopped the study.
    #[error(transparent)]
    Playback(#[from] PlaybackError),
    /// A point of the study is not a valid design.
    #[error(transparent)]
    Design(#[from] ConfigError),
    /// The folder cannot be written.
    #[error(transparent)]
    Output(#[from] StagingError),
    /// A study of change got a data set, whose frames have no order.
    #[error(
        "`{name}` is a set of unrelated images, in which nothing changes; the study {study} needs clips"
    )]
    DataSet { name: String, study: &'static str },
    /// The study `sensor` needs the events of a sensor.
    #[error(
        "the study `sensor` needs the events of a real sensor; name their file with --sensor-events"
    )]
    NoSensorEvents,
    /// The study `sensor` takes a single clip.
    #[error("the study `sensor` takes one clip, but {clips} are given")]
    SeveralClips { clips: usize },
    /// The events of the sensor cannot be read.
    #[error("cannot read sensor events `{}`: {problem}; events are CSV with the columns t_us, x, y, sorted by time, or a file in EVT 2.0, EVT 3.0 or AEDAT4", path.display())]
    SensorEvents { path: PathBuf, problem: String },
    /// No event of the recording falls into the time of the clip.
    #[error(
        "no event of `{}` lies within the time of the clip, which is {first} to {last} us with \
         --sensor-start {first}. The events are from {from} to {to} us; set --sensor-start to the \
         time of the first frame on that clock",
        path.display()
    )]
    SensorTime { path: PathBuf, first: u64, last: u64, from: u64, to: u64 },
    /// The study `recall` needs ground-truth boxes.
    #[error(
        "the study `recall` needs ground-truth boxes of objects; name their file or folder with --boxes"
    )]
    NoBoxes,
    /// There are no objects to count.
    #[error(
        "`{clips}` has no object to count after its first frame{}; check --boxes, and use more \
         frames, or --images set for unrelated images",
        left_out.iter().map(|sentence| format!(": {sentence}")).collect::<String>()
    )]
    NoObjects { clips: String, left_out: Vec<String> },
    /// A chart cannot be drawn.
    #[error(transparent)]
    Chart(#[from] ChartError),
}
