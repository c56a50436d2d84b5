// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame that a player returned. When it is dropped, its memory goes back to the reader.

use std::ops::Deref;
use std::sync::mpsc::Sender;

use crate::{FrameOrigin, SourceFrame, SourceKind};
use foveate_engine::{Engine, FrameOutcome};
use foveate_pixels::ByteFrame;

use crate::playback::PlaybackError;

/// A frame of a clip or data set.
#[derive(Debug)]
pub struct PlayedFrame {
    /// The number of the frame in its clip, from 0.
    pub number: u64,
    /// The relation between the frames of the clip.
    pub kind: SourceKind,
    /// The origin of the frame, if the source knows it.
    pub origin: Option<FrameOrigin>,
    /// The frame; `None` only while it is dropped.
    shown: Option<SourceFrame>,
    used: Sender<SourceFrame>,
}

impl PlayedFrame {
    pub(crate) fn new(
        (shown, origin): (SourceFrame, Option<FrameOrigin>),
        number: u64,
        kind: SourceKind,
        used: Sender<SourceFrame>,
    ) -> Self {
        Self { number, kind, origin, shown: Some(shown), used }
    }

    /// Returns true if the frame has no frame before it: the first frame of a clip, and every frame
    /// of a data set. A camera is reset before such a frame.
    #[must_use]
    pub fn is_first(&self) -> bool {
        match self.kind {
            SourceKind::Clip => self.number == 0,
            SourceKind::Set => true,
        }
    }

    /// Shows the frame to a camera of its depth, which is reset before a first frame.
    ///
    /// # Errors
    /// Fails if the frame does not have the camera's size and depth.
    pub fn show_to<'a>(&self, engine: &'a mut Engine) -> Result<&'a FrameOutcome, PlaybackError> {
        self.show_pixels_to(engine, &self.frame)
    }

    /// Shows these pixels, which are the frame in the camera's depth, as [`PlayedFrame::show_to`]
    /// does.
    pub(crate) fn show_pixels_to<'a>(
        &self,
        engine: &'a mut Engine,
        pixels: &ByteFrame,
    ) -> Result<&'a FrameOutcome, PlaybackError> {
        if self.is_first() {
            engine.reset();
        }
        Ok(engine.step_byte_frame(pixels)?)
    }
}

impl Deref for PlayedFrame {
    type Target = SourceFrame;

    fn deref(&self) -> &SourceFrame {
        self.shown.as_ref().expect("it is there until the drop")
    }
}

impl Drop for PlayedFrame {
    fn drop(&mut self) {
        if let Some(shown) = self.shown.take() {
            // A reader that has ended needs no memory.
            let _ = self.used.send(shown);
        }
    }
}
