// SPDX-License-Identifier: MIT OR Apache-2.0
//! The time that a session waits until all pixels of a frame have left.

use foveate_design::{Design, Hardware, PipelinedDesign, PipelinedTiming};

/// The time that a core needs after a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct DrainTiming {
    /// The number of clocks after which everything is decided that does not wait for another frame;
    /// `None` if the core shows this by its own outputs.
    pub(super) settling_clocks: Option<u64>,
    /// The number of frames that must follow before the pixels of a frame have left.
    pub(super) frames_behind: u32,
    /// The largest number of clocks that are simulated after a sequence has left.
    pub(super) trailing_clocks: u64,
}

impl DrainTiming {
    pub(super) fn for_design(design: &Design) -> Self {
        match design.hardware() {
            Hardware::Pipelined(own) => {
                let design = design.with_hardware(own);
                let frames_behind = PipelinedTiming::from_design(design).forward_frames;
                Self {
                    settling_clocks: Some(settling_clocks(design)),
                    frames_behind,
                    trailing_clocks: 0,
                }
            }
            Hardware::Serial(_) => {
                Self { settling_clocks: None, frames_behind: 0, trailing_clocks: 5 }
            }
            Hardware::Raster(_) => {
                Self { settling_clocks: None, frames_behind: 0, trailing_clocks: 8 }
            }
        }
    }
}

/// Returns the number of clocks after the last pixel of a frame after which a pipelined array has
/// decided everything that does not wait for another frame.
pub(crate) fn settling_clocks(design: PipelinedDesign<'_>) -> u64 {
    u64::from(PipelinedTiming::from_design(design).decision_latency) + 4
}
