// SPDX-License-Identifier: MIT OR Apache-2.0
//! The leaf `frame_sync`, which finds the frames of a stream again, in front of the array or core
//! of a design with `hardware.sync`.

use foveate_design::Design;

/// The values for the instance of `frame_sync` in the template of a top.
pub(crate) struct FrameSync {
    /// The number of beats of a frame, in terms of the grid.
    pub(crate) beats: String,
    /// True if the array behind `frame_sync` takes a beat at every clock.
    pub(crate) is_always_open: bool,
}

impl FrameSync {
    /// Returns the values for an array that takes a beat at every clock; `None` without
    /// `hardware.sync`.
    pub(crate) fn without_ready(design: &Design, beats: String) -> Option<Self> {
        design.has_frame_sync().then_some(Self { beats, is_always_open: true })
    }

    /// Returns the values for an array or core with a ready output; `None` without `hardware.sync`.
    pub(crate) fn with_ready(design: &Design, beats: String) -> Option<Self> {
        design.has_frame_sync().then_some(Self { beats, is_always_open: false })
    }
}

/// Returns the signal that the valid input of the array or core is connected to.
pub(crate) fn valid_signal(design: &Design) -> &'static str {
    if design.has_frame_sync() { "beat" } else { "valid_i" }
}

/// Returns the signal that the ready output of the array or core is connected to.
pub(crate) fn ready_signal(design: &Design) -> &'static str {
    if design.has_frame_sync() { "open" } else { "ready_o" }
}
