// SPDX-License-Identifier: MIT OR Apache-2.0
//! How far a serial design can be folded before it is too slow, and which folds may be the cheapest.

use super::{Phase, SerialTiming};
use crate::{Design, Hardware, SerialDesign};
use foveate_camera::ConfigError;

impl Design {
    /// The same design with another fold.
    ///
    /// # Errors
    /// Where `fold` is not 1..=M, or more than 1 in an organization that does not fold.
    pub fn with_fold(&self, fold: u32) -> Result<Self, ConfigError> {
        let mut config = self.config();
        config.hardware.fold = fold;
        config.validate()
    }

    /// The largest fold, hence the fewest lanes, with which the design takes at most `max_clocks` per
    /// frame. Fold 1 is always the fastest: where it is too slow there is none, and there is none in an
    /// organization that does not fold.
    #[must_use]
    pub fn largest_fold(&self, max_clocks: u64) -> Option<u32> {
        let single = self.with_fold(1).ok()?;
        let fastest = match single.hardware() {
            Hardware::Serial(own) => SerialTiming::of(single.on(own)),
            Hardware::Pipelined(_) | Hardware::Raster(_) => return None,
        };
        // What every slot takes at least, whatever the lanes.
        let least: u64 = fastest.phases().iter().map(least_steps).sum();
        let most = u32::try_from(max_clocks / least.max(1)).unwrap_or(u32::MAX);
        let reaches = |fold: &u32| {
            let folded = self.with_fold(*fold);
            folded.is_ok_and(|design| design.timing().clocks_per_frame() <= max_clocks)
        };
        (1..=most.min(self.regions())).rev().find(reaches)
    }

    /// The folds that may be the cheapest with at most `max_clocks` per frame, that with the fewest lanes first. Lanes
    /// are logic, and what else a fold costs are the block RAMs of their memories. So every fold that is not here has
    /// no fewer lanes than one that is, and no fewer block RAMs. Of those with as many lanes it is the one that leaves
    /// the fewest slots empty. Empty where [`Self::largest_fold`] is none.
    #[must_use]
    pub fn frugal_folds(&self, max_clocks: u64) -> Vec<u32> {
        let Some(largest) = self.largest_fold(max_clocks) else { return Vec::new() };
        let (mut folds, mut fewest_blocks) = (Vec::new(), u64::MAX);
        for lanes in self.regions().div_ceil(largest)..=self.regions() {
            let fold = self.regions().div_ceil(lanes);
            if self.regions().div_ceil(fold) != lanes {
                continue;
            }
            let Ok(folded) = self.with_fold(fold) else { continue };
            let blocks = match folded.hardware() {
                Hardware::Serial(own) => lane_blocks(folded.on(own)),
                Hardware::Pipelined(_) | Hardware::Raster(_) => return Vec::new(),
            };
            // Fewer slots take fewer clocks, so it is fast enough.
            if blocks < fewest_blocks {
                folds.push(fold);
                fewest_blocks = blocks;
            }
            if fewest_blocks == 0 {
                break;
            }
        }
        folds
    }
}

/// RAMB18 of the memories of all lanes.
fn lane_blocks(design: SerialDesign<'_>) -> u64 {
    let (_, blocks) = design.lane_memory().taken();
    blocks * u64::from(design.lanes())
}

fn least_steps((phase, steps): &(Phase, u64)) -> u64 {
    match phase {
        Phase::RotateCount
        | Phase::Means
        | Phase::RotateScore(_)
        | Phase::Unload
        | Phase::UnloadMeans => 0,
        Phase::DenoiseTemporal | Phase::Border | Phase::Temporal | Phase::Pass(_) | Phase::Copy => {
            *steps
        }
    }
}
