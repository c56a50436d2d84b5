// SPDX-License-Identifier: MIT OR Apache-2.0
//! The leaf that finds the frames of a stream again, in front of the array or core of a design that has it.

use foveate_design::Design;

/// What the template of a top says of its `frame_sync`.
pub(crate) struct Sync {
    /// Beats of a frame, in terms of the grid.
    pub(crate) beats: String,
    /// Whether what is behind takes a beat at every clock.
    pub(crate) is_always_open: bool,
}

impl Sync {
    /// In front of what takes a beat at every clock; none where the design has none.
    pub(crate) fn always_open(design: &Design, beats: String) -> Option<Self> {
        design.syncs().then_some(Self { beats, is_always_open: true })
    }

    /// In front of what says when it takes a beat.
    pub(crate) fn with_ready(design: &Design, beats: String) -> Option<Self> {
        design.syncs().then_some(Self { beats, is_always_open: false })
    }
}

/// The port that the valid input of what is behind is connected to.
pub(crate) fn valid(design: &Design) -> &'static str {
    if design.syncs() { "beat" } else { "valid_i" }
}

/// The port that its ready output is connected to.
pub(crate) fn ready(design: &Design) -> &'static str {
    if design.syncs() { "open" } else { "ready_o" }
}
