// SPDX-License-Identifier: MIT OR Apache-2.0
//! The time until all pixels of a frame have left.

use foveate_design::{Design, Hardware, PipelinedDesign, PipelinedTiming};

/// The time that a core needs after a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrainTiming {
    /// The number of clocks after the last pixel of a frame until everything is decided that does
    /// not wait for another frame. A core that is ready earlier may need more clocks.
    pub(crate) settling_clocks: u64,
    /// True if the core shows by its own outputs that everything has left.
    shows_end: bool,
    /// The number of frames that must follow before the pixels of a frame have left.
    pub(crate) frames_behind: u32,
    /// The largest number of clocks that are simulated after a sequence has left.
    pub(super) trailing_clocks: u64,
}

impl DrainTiming {
    /// Returns the number of clocks to wait until everything is decided, or `None` if the core
    /// shows by its own outputs that everything has left.
    pub(super) fn clocks_to_wait(&self) -> Option<u64> {
        (!self.shows_end).then_some(self.settling_clocks)
    }

    pub(crate) fn for_design(design: &Design) -> Self {
        match design.hardware() {
            Hardware::Pipelined(own) => {
                let design = design.with_hardware(own);
                Self {
                    settling_clocks: settling_clocks(design),
                    shows_end: false,
                    frames_behind: PipelinedTiming::from_design(design).forward_frames,
                    trailing_clocks: 0,
                }
            }
            Hardware::Serial(_) => {
                Self { settling_clocks: 0, shows_end: true, frames_behind: 0, trailing_clocks: 5 }
            }
            Hardware::Raster(_) => {
                let departure = design.timing().departure();
                Self {
                    settling_clocks: departure.decision_clocks.max(departure.forward_clocks),
                    shows_end: true,
                    frames_behind: 0,
                    trailing_clocks: 8,
                }
            }
        }
    }
}

/// Returns the number of clocks after the last pixel of a frame after which a pipelined array has
/// decided everything that does not wait for another frame.
pub(super) fn settling_clocks(design: PipelinedDesign<'_>) -> u64 {
    u64::from(PipelinedTiming::from_design(design).decision_latency) + 4
}
