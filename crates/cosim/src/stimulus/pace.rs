// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a session waits for: until everything of a frame has left.

use foveate_design::{Design, Hardware, PipelinedDesign, PipelinedTiming};

/// How long a core goes on after a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// Clocks after which everything has settled that does not wait for another frame; `None` where the core says
    /// so itself, by what it takes and what it shows.
    pub(super) settle: Option<u64>,
    /// Frames that must follow until the pixels of a frame have left.
    pub(super) frames_behind: u32,
    /// Clocks that are simulated after the last of a sequence has left, at most.
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

/// Clocks after the last pixel of a frame in which a pipelined array settles, as far as it does without another frame.
pub(crate) fn settling_clocks(design: PipelinedDesign<'_>) -> u64 {
    u64::from(PipelinedTiming::of(design).decision_latency) + 4
}
