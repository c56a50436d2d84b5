// SPDX-License-Identifier: MIT OR Apache-2.0
//! How far a serial design can be folded before it is too slow.

use super::{Phase, SerialTiming};
use crate::{Design, DesignError};

impl Design {
    /// The same design with another fold.
    ///
    /// # Errors
    /// Where `fold` is not 1..=M, or more than 1 in an organization that does not fold.
    pub fn with_fold(&self, fold: u32) -> Result<Self, DesignError> {
        let mut config = self.config().clone();
        config.hardware.fold = fold;
        config.validate()
    }

    /// The largest fold, hence the fewest lanes, with which the design takes at most `max_clocks` per
    /// frame. Fold 1 is always the fastest: where it is too slow there is none, and there is none in an
    /// organization that does not fold.
    #[must_use]
    pub fn largest_fold(&self, max_clocks: u64) -> Option<u32> {
        if !self.organization().folds() {
            return None;
        }
        let fastest = SerialTiming::of(&self.with_fold(1).ok()?);
        // What every slot takes at least, whatever the lanes.
        let least: u64 = fastest.phases().iter().map(least_steps).sum();
        let most = u32::try_from(max_clocks / least.max(1)).unwrap_or(u32::MAX);
        let reaches = |fold: &u32| {
            let folded = self.with_fold(*fold);
            folded.is_ok_and(|d| SerialTiming::of(&d).clocks_per_frame() <= max_clocks)
        };
        (1..=most.min(self.regions())).rev().find(reaches)
    }
}

fn least_steps((phase, steps): &(Phase, u64)) -> u64 {
    match phase {
        Phase::RotateCount | Phase::RotateScore(_) | Phase::Unload => 0,
        Phase::DenoiseTemporal | Phase::Border | Phase::Temporal | Phase::Pass(_) | Phase::Copy => {
            *steps
        }
    }
}
