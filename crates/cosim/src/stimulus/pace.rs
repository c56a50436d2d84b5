// SPDX-License-Identifier: MIT OR Apache-2.0
//! The time that a session waits until all pixels of a frame have left.

use foveate_design::{Design, Hardware, PipelinedDesign, PipelinedTiming};

/// The time that a core needs after a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// The number of clocks after which everything is decided that does not wait for another frame;
    /// `None` if the core shows this by its own outputs.
    pub(super) settle: Option<u64>,
    /// The number of frames that must follow before the pixels of a frame have left.
    pub(super) frames_behind: u32,
    /// The largest number of clocks that are simulated after a sequence has left.
    pub(super) silence: u64,
}

impl Pace {
    pub(super) fn of(design: &Design) -> Self {
        match design.hardware() {
            Hardware::Pipelined(own) => {
                let design = design.on(own);
                let frames_behind = PipelinedTiming::of(design).forward_frames;
                Self { settle: Some(settling_clocks(design)), frames_behind, silence: 0 }
            }
            Hardware::Serial(_) => Self { settle: None, frames_behind: 0, silence: 5 },
            Hardware::Raster(_) => Self { settle: None, frames_behind: 0, silence: 8 },
        }
    }
}

/// Returns the number of clocks after the last pixel of a frame after which a pipelined array has
/// decided everything that does not wait for another frame.
pub(crate) fn settling_clocks(design: PipelinedDesign<'_>) -> u64 {
    u64::from(PipelinedTiming::of(design).decision_latency) + 4
}
