// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choice of the fold of a serial design: the folds that are fast enough, and the ones
//! among them that may be the cheapest.

use super::{SerialPhase, SerialTiming};
use crate::{Design, Hardware, OrganizationConfig, SerialDesign};
use foveate_camera::ConfigError;

impl Design {
    /// Returns the same design with another fold.
    ///
    /// # Errors
    /// Returns an error if `fold` is not in 1..=M, or is more than 1 in an organization without
    /// folding.
    pub fn with_fold(&self, fold: u32) -> Result<Self, ConfigError> {
        let mut config = self.config();
        match (&mut config.hardware.organization, fold) {
            (OrganizationConfig::Serial(own), _) => own.fold = fold,
            (OrganizationConfig::Pipelined | OrganizationConfig::Raster(_), 1) => {}
            (OrganizationConfig::Pipelined | OrganizationConfig::Raster(_), _) => {
                return Err(self.organization().folding_error(fold.to_string()));
            }
        }
        config.validate()
    }

    /// Returns the largest fold, and so the fewest lanes, with which the design takes at most
    /// `max_clocks` clocks per frame. Fold 1 is always the fastest. Returns `None` if fold 1 is too
    /// slow, or if the organization has no folding.
    #[must_use]
    pub fn largest_fold(&self, max_clocks: u64) -> Option<u32> {
        let single = self.with_fold(1).ok()?;
        let fastest = match single.hardware() {
            Hardware::Serial(own) => SerialTiming::from_design(single.with_hardware(own)),
            Hardware::Pipelined(_) | Hardware::Raster(_) => return None,
        };
        // `least` is a lower bound of the steps of a slot, which holds for any number of lanes.
        let least: u64 = fastest.phases().iter().map(least_steps).sum();
        let most = u32::try_from(max_clocks / least.max(1)).unwrap_or(u32::MAX);
        let reaches = |fold: &u32| {
            let folded = self.with_fold(*fold);
            folded.is_ok_and(|design| design.timing().clocks_per_frame() <= max_clocks)
        };
        (1..=most.min(self.regions())).rev().find(reaches)
    }

    /// Returns the folds that may be the cheapest with at most `max_clocks` clocks per frame, the
    /// one with the fewest lanes first. The cost of a fold is the logic of its lanes and the block
    /// RAMs of their memories. For every other fold that is fast enough there is one in the list
    /// with no more lanes and no more block RAMs. Among folds with the same number of lanes, the
    /// list has the one with the fewest empty slots. The list is empty if [`Self::largest_fold`]
    /// returns `None`.
    #[must_use]
    pub fn pareto_folds(&self, max_clocks: u64) -> Vec<u32> {
        let Some(largest) = self.largest_fold(max_clocks) else { return Vec::new() };
        let (mut folds, mut fewest_blocks) = (Vec::new(), u64::MAX);
        for lanes in self.regions().div_ceil(largest)..=self.regions() {
            let fold = self.regions().div_ceil(lanes);
            if self.regions().div_ceil(fold) != lanes {
                continue;
            }
            let Ok(folded) = self.with_fold(fold) else { continue };
            let blocks = match folded.hardware() {
                Hardware::Serial(own) => lane_blocks(folded.with_hardware(own)),
                Hardware::Pipelined(_) | Hardware::Raster(_) => return Vec::new(),
            };
            // A fold with fewer slots takes fewer clocks, so this fold is fast enough.
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

/// Returns the number of RAMB18 in the memories of all lanes.
fn lane_blocks(design: SerialDesign<'_>) -> u64 {
    let (_, blocks) = design.lane_memory().resources();
    blocks * u64::from(design.lanes())
}

fn least_steps((phase, steps): &(SerialPhase, u64)) -> u64 {
    match phase {
        SerialPhase::PassClasses
        | SerialPhase::RotateCount
        | SerialPhase::ComputeMeans
        | SerialPhase::RotateScore(_)
        | SerialPhase::UnloadPixels
        | SerialPhase::UnloadMeans => 0,
        SerialPhase::DenoiseAndCompare
        | SerialPhase::RepeatBorder
        | SerialPhase::CompareRaw
        | SerialPhase::FeaturePass(_)
        | SerialPhase::CopyReference => *steps,
    }
}
