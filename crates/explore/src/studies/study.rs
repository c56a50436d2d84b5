// SPDX-License-Identifier: MIT OR Apache-2.0
//! The studies.

pub(crate) mod activity;
pub(crate) mod histogram;
pub(crate) mod recall;
pub(crate) mod redundancy;
pub(crate) mod sensor;
pub(crate) mod sweep;
pub(crate) mod temporal;

use foveate_media::SourceKind;

use crate::studies::StudyError;
use crate::studies::runner::ClipResult;

/// A study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Study {
    /// The active, SRS and TRS shares over time.
    Activity,
    /// The shares over whole clips.
    Temporal,
    /// The share of irrelevant regions for each feature.
    Redundancy,
    /// The distribution of the mean absolute deviation.
    MadHistogram,
    /// The active share over the region size.
    Size,
    /// The active share over the thresholds.
    Threshold,
    /// The rank correlation with the events of a real sensor.
    Sensor,
    /// The share of objects whose regions are active, over bytes.
    Recall,
}

impl Study {
    /// All studies, in the order of the documentation.
    pub const ALL: [Self; 8] = [
        Self::Activity,
        Self::Temporal,
        Self::Redundancy,
        Self::MadHistogram,
        Self::Size,
        Self::Threshold,
        Self::Sensor,
        Self::Recall,
    ];

    /// Returns the name on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Activity => "activity",
            Self::Temporal => "temporal",
            Self::Redundancy => "redundancy",
            Self::MadHistogram => "mad-histogram",
            Self::Size => "size",
            Self::Threshold => "threshold",
            Self::Sensor => "sensor",
            Self::Recall => "recall",
        }
    }
}

/// Refuses data sets in studies of change.
fn refuse_data_sets<T, G>(study: Study, watched: &[ClipResult<T, G>]) -> Result<(), StudyError> {
    match watched.iter().find(|clip| clip.kind == SourceKind::Set) {
        Some(set) => Err(StudyError::DataSet { name: set.name.clone(), study: study.name() }),
        None => Ok(()),
    }
}
