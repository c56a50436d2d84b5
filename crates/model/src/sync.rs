// SPDX-License-Identifier: MIT OR Apache-2.0
//! Finds the frames of a stream whose first beats are marked: what `docs/sync.md` puts in front of an array.

use foveate_design::Design;

/// What an array takes at an edge, and what becomes of the stream; as after a reset when new.
///
/// [`crate::PipelinedRcm`], [`crate::SerialRcm`] and [`crate::RasterRcm`] have one. Whoever steps the regions in
/// another way puts one in front.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameSync {
    /// Beats of a frame; none where the design does not find its frames, and every beat is passed on.
    beats: Option<u64>,
    state: State,
    is_error: bool,
}

/// Where in the stream it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// No frame is under way.
    Seek,
    /// A frame has just had all its beats.
    Start,
    /// A frame is under way, and has had so many beats.
    Inside(u64),
    /// The array completes the frame under way by itself, which has had so many beats.
    Fill(u64),
}

impl FrameSync {
    /// That of the design.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        let beats = design.syncs().then(|| design.timing().pixels_per_frame());
        Self { beats, state: State::Seek, is_error: false }
    }

    /// Where nothing finds the frames: every beat is passed on.
    #[must_use]
    pub fn absent() -> Self {
        Self { beats: None, state: State::Seek, is_error: false }
    }

    /// One rising edge without reset, before which the array is `open`: whether the array takes a beat.
    pub fn step(&mut self, valid: bool, sof: bool, open: bool) -> bool {
        let Some(beats) = self.beats else { return valid && open };
        self.is_error = false;
        if let State::Fill(had) = self.state {
            if open {
                let is_last = had + 1 == beats;
                self.state = if is_last { State::Seek } else { State::Fill(had + 1) };
            }
            return open;
        }
        if !(valid && open) {
            return false;
        }
        let (next, is_passed, is_error) = match (self.state, sof) {
            (State::Seek | State::Start, true) => (State::Inside(1), true, false),
            (State::Seek, false) => (State::Seek, false, false),
            (State::Start, false) => (State::Seek, false, true),
            (State::Inside(had) | State::Fill(had), true) => (State::Fill(had), false, true),
            (State::Inside(had) | State::Fill(had), false) => {
                let is_last = had + 1 == beats;
                (if is_last { State::Start } else { State::Inside(had + 1) }, true, false)
            }
        };
        (self.state, self.is_error) = (next, is_error);
        is_passed
    }

    /// An edge with `rst_i`.
    pub fn reset(&mut self) {
        (self.state, self.is_error) = (State::Seek, false);
    }

    /// `sync_error_o` after the last edge.
    #[must_use]
    pub fn is_error(&self) -> bool {
        self.is_error
    }

    /// Whether the array completes a frame by itself, so that nothing is taken from outside.
    #[must_use]
    pub fn is_filling(&self) -> bool {
        matches!(self.state, State::Fill(_))
    }
}
