// SPDX-License-Identifier: MIT OR Apache-2.0
//! Which studies there are.

pub(crate) mod activity;
pub(crate) mod histogram;
pub(crate) mod recall;
pub(crate) mod redundancy;
pub(crate) mod sensor;
pub(crate) mod sweep;
pub(crate) mod temporal;

use foveate_footage::Kind;

use crate::StudyError;
use crate::watch::Watched;

/// A study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Study {
    /// Active, SRS and TRS share over time.
    Activity,
    /// Shares over whole clips.
    Temporal,
    /// Share of regions without relevance, per feature.
    Redundancy,
    /// How the mean absolute deviation is distributed.
    MadHistogram,
    /// Active share against the region size.
    Size,
    /// Active share against the thresholds.
    Threshold,
    /// Rank correlation with a real sensor's own events.
    Sensor,
    /// Share of objects whose regions are active, against bytes.
    Recall,
}

impl Study {
    /// All of them, in the order of the documentation.
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

    /// Its name on the command line and in files.
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

/// Refuses sets where change is studied.
fn clips_only<T>(study: Study, watched: &[Watched<T>]) -> Result<(), StudyError> {
    match watched.iter().find(|clip| clip.kind == Kind::Set) {
        Some(set) => Err(StudyError::Set { name: set.name.clone(), study: study.name() }),
        None => Ok(()),
    }
}
