// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for frames in a stream whose first beats are marked, by the rules of `docs/sync.md`.
//! It is in front of an array.

use foveate_design::Design;

/// The state of the search for frames. It decides for every beat of the stream whether the array
/// takes it.
///
/// [`crate::PipelinedRcm`], [`crate::SerialRcm`] and [`crate::RasterRcm`] contain one. A driver
/// that clocks single RPUs must put one in front of them.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameSync {
    /// Number of beats of a frame, or `None` for a design without `hardware.sync`, which takes
    /// every beat.
    beats: Option<u64>,
    state: SyncState,
    is_error: bool,
}

/// The position in the stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SyncState {
    /// No frame is under way.
    Seek,
    /// A frame has just received its last beat.
    Start,
    /// A frame is under way and has received this number of beats.
    Inside(u64),
    /// The array completes the frame under way by itself. The frame has this number of beats.
    Fill(u64),
}

impl FrameSync {
    /// Makes the state after a reset for the design.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        let beats = design.has_frame_sync().then(|| design.timing().pixels_per_frame());
        Self { beats, state: SyncState::Seek, is_error: false }
    }

    /// Makes the state of a design without `hardware.sync`: the array takes every beat.
    #[must_use]
    pub fn without_sync() -> Self {
        Self { beats: None, state: SyncState::Seek, is_error: false }
    }

    /// Applies one rising edge without reset. `open` is true if the array is ready before the edge.
    /// Returns true if the array takes a beat.
    pub fn step(&mut self, valid: bool, sof: bool, open: bool) -> bool {
        let Some(beats) = self.beats else { return valid && open };
        self.is_error = false;
        if let SyncState::Fill(had) = self.state {
            if open {
                let is_last = had + 1 == beats;
                self.state = if is_last { SyncState::Seek } else { SyncState::Fill(had + 1) };
            }
            return open;
        }
        if !(valid && open) {
            return false;
        }
        let (next, is_passed, is_error) = match (self.state, sof) {
            (SyncState::Seek | SyncState::Start, true) => (SyncState::Inside(1), true, false),
            (SyncState::Seek, false) => (SyncState::Seek, false, false),
            (SyncState::Start, false) => (SyncState::Seek, false, true),
            (SyncState::Inside(had) | SyncState::Fill(had), true) => {
                (SyncState::Fill(had), false, true)
            }
            (SyncState::Inside(had) | SyncState::Fill(had), false) => {
                let is_last = had + 1 == beats;
                (if is_last { SyncState::Start } else { SyncState::Inside(had + 1) }, true, false)
            }
        };
        (self.state, self.is_error) = (next, is_error);
        is_passed
    }

    /// Applies an edge with `rst_i`.
    pub fn reset(&mut self) {
        (self.state, self.is_error) = (SyncState::Seek, false);
    }

    /// Returns `sync_error_o` after the last edge.
    #[must_use]
    pub fn is_error(&self) -> bool {
        self.is_error
    }

    /// Returns true if the array completes a frame by itself, so that it takes no beats of the
    /// stream.
    #[must_use]
    pub fn is_filling(&self) -> bool {
        matches!(self.state, SyncState::Fill(_))
    }
}
