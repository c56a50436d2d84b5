// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums over frames.

use serde::{Deserialize, Serialize};

use crate::areas::Areas;
use crate::picture::PictureTally;
use crate::scores::ScoreTally;
use crate::stale::StaleTally;

/// Sums over frames; what can be added and stored. Whole numbers only: the same frames give the same
/// tally in whatever order and on however many threads their clips were compared.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ErrorTally {
    pub(crate) frames: u64,
    /// Pixels of all frames.
    pub(crate) pixels: u64,
    /// Largest pixel of the ideal camera.
    pub(crate) peak: u32,
    pub(crate) scores: Vec<ScoreTally>,
    pub(crate) areas: Areas,
    pub(crate) to_ideal: PictureTally,
    pub(crate) to_input: PictureTally,
    pub(crate) stale: StaleTally,
}

impl ErrorTally {
    /// Adds the frames of another tally: of the same two cameras, but for the size of the frames.
    ///
    /// Scores are added by name. Of different depths the largest pixel counts, for PSNR, which then says
    /// little.
    pub fn merge(&mut self, other: &Self) {
        self.frames += other.frames;
        self.pixels += other.pixels;
        self.peak = self.peak.max(other.peak);
        for score in &other.scores {
            match self.scores.iter_mut().find(|own| own.feature == score.feature) {
                Some(own) => own.add(score),
                None => self.scores.push(score.clone()),
            }
        }
        self.areas.add(&other.areas);
        self.to_ideal.add(&other.to_ideal);
        self.to_input.add(&other.to_input);
        self.stale.add(&other.stale);
    }

    /// Frames that were added.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }
}
