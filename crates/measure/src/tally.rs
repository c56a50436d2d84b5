// SPDX-License-Identifier: MIT OR Apache-2.0
//! The sums over frames.

use crate::areas::DecisionAreas;
use crate::scores::ScoreTally;
use crate::screens::ScreenTally;
use crate::staleness::StalenessTally;
use serde::{Deserialize, Serialize};

/// The sums over frames, which can be added and stored. They are whole numbers, so the same frames
/// give the same tally, in any order of the clips and on any number of threads.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ErrorTally {
    pub(crate) frames: u64,
    /// The largest possible pixel of the ideal camera.
    pub(crate) peak: u32,
    pub(crate) scores: Vec<ScoreTally>,
    pub(crate) areas: DecisionAreas,
    pub(crate) to_ideal: ScreenTally,
    pub(crate) to_input: ScreenTally,
    /// The difference between the candidate's screen and the ideal's denoised frame.
    pub(crate) stale: StalenessTally,
    /// The difference between the candidate's screen and its own denoised frame.
    pub(crate) stale_to_own: StalenessTally,
}

impl ErrorTally {
    /// Adds the frames of another tally. It must belong to the same two cameras, but the size of
    /// the frames may differ.
    ///
    /// Scores are added by name. If the depths differ, the largest peak is used for the PSNR, which
    /// then has little meaning.
    pub fn merge(&mut self, other: &Self) {
        self.frames += other.frames;
        self.peak = self.peak.max(other.peak);
        for score in &other.scores {
            match self.scores.iter_mut().find(|tally| tally.feature == score.feature) {
                Some(tally) => tally.add(score),
                None => self.scores.push(score.clone()),
            }
        }
        self.areas.add(&other.areas);
        self.to_ideal.add(&other.to_ideal);
        self.to_input.add(&other.to_input);
        self.stale.add(&other.stale);
        self.stale_to_own.add(&other.stale_to_own);
    }

    /// Returns the areas of the decisions.
    #[must_use]
    pub fn decisions(&self) -> &DecisionAreas {
        &self.areas
    }

    /// Returns the number of frames that were added.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }
}
