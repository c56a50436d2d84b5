// SPDX-License-Identifier: MIT OR Apache-2.0
//! The two streams of a core with an external frame store: the references that it takes, and the
//! words that it stores. Both events are a fixed number of clocks after a word has come to the
//! tail.

use foveate_camera::Camera;
use foveate_design::{RasterDesign, RasterTiming};
use foveate_pixels::Frame;

use super::advances::WordPosition;
use super::decisions::{CompletedRegion, DueQueue, take_due};
use super::readout::WordPixels;
use crate::denoising::denoised_pixels;
use crate::region::black_padded_frame;

/// The state of the two streams.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ExternalStorePorts {
    camera: Camera,
    timing: RasterTiming,
    /// Words whose references have not been taken yet, in order, with the edges at which they are
    /// due.
    reference_requests: DueQueue<ReferenceRequest>,
    /// Words that have not been stored yet, in order, with the edges at which they are due.
    store_words: DueQueue<StoreWord>,
    /// The references of the frame in the tail, as they were taken.
    references: Frame,
    /// Number of frames whose first word has come to the tail since reset.
    frames: u64,
    /// True if a reference was taken that was not valid.
    underrun: bool,
}

/// A word whose reference is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ReferenceRequest {
    place: WordPosition,
    /// True in all frames except the first.
    has_reference: bool,
    /// The region whose last word this is, if it is one.
    complete: Option<CompletedRegion>,
}

/// A word on its way to the store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct StoreWord {
    /// The scored pixels of the word.
    pub(super) pixels: WordPixels,
    /// True if the word is the last of its row.
    pub(super) is_last: bool,
}

impl ExternalStorePorts {
    pub(super) fn new(design: RasterDesign<'_>) -> Self {
        Self {
            timing: RasterTiming::from_design(design),
            reference_requests: DueQueue::new(),
            store_words: DueQueue::new(),
            references: black_padded_frame(&design),
            frames: 0,
            underrun: false,
            camera: design.camera().clone(),
        }
    }

    /// Resets the streams: nothing is under way, and the next frame is the first.
    pub(super) fn reset(&mut self) {
        self.reference_requests.clear();
        self.store_words.clear();
        (self.frames, self.underrun) = (0, false);
    }

    /// Records a word that comes to the tail at edge `now`. `complete` is the region whose last
    /// word it is, if it is one.
    pub(super) fn push_word(
        &mut self,
        now: u64,
        place: WordPosition,
        complete: Option<CompletedRegion>,
        padded: &Frame,
    ) {
        self.frames += u64::from(place == WordPosition { row: 0, column: 0 });
        let asking = ReferenceRequest { place, has_reference: self.frames > 1, complete };
        self.reference_requests.push_back((now + u64::from(self.timing.lookup_latency), asking));
        let stored = StoreWord {
            pixels: self.scored_word(place, padded),
            is_last: place.column == self.timing.row_words - 1,
        };
        self.store_words.push_back((now + u64::from(self.timing.store_latency), stored));
    }

    /// Applies edge `now`, at which the port shows the word `port`. If a reference is due, the word
    /// is taken. Returns the region that has all of its references from now on, if there is one.
    pub(super) fn take_reference(
        &mut self,
        now: u64,
        valid: bool,
        port: &[u16],
    ) -> Option<CompletedRegion> {
        let asking = take_due(&mut self.reference_requests, now)?;
        if asking.has_reference {
            let left = asking.place.column * self.timing.word_pixels;
            self.references.write_row(left, asking.place.row, port);
            self.underrun |= !valid;
        }
        asking.complete
    }

    /// Returns the word that is on the store port after edge `now`, or `None`.
    pub(super) fn take_store_word(&mut self, now: u64) -> Option<StoreWord> {
        take_due(&mut self.store_words, now)
    }

    /// Returns true if a reference is taken at the edge after `now`.
    pub(super) fn is_reference_due_after(&self, now: u64) -> bool {
        self.reference_requests
            .front()
            .is_some_and(|(due, asking)| *due == now + 1 && asking.has_reference)
    }

    /// Returns true if a region waits for the reference of its last word.
    pub(super) fn has_waiting_region(&self) -> bool {
        self.reference_requests.iter().any(|(_, asking)| asking.complete.is_some())
    }

    /// Returns the references as they were taken.
    pub(super) fn references(&self) -> &Frame {
        &self.references
    }

    pub(super) fn has_underrun(&self) -> bool {
        self.underrun
    }

    fn scored_word(&self, place: WordPosition, padded: &Frame) -> WordPixels {
        let Self { camera, timing, .. } = self;
        let region = place.row / camera.region_size() * camera.columns()
            + place.column / timing.region_row_words;
        let left = place.column * timing.word_pixels;
        let columns = left..left + timing.word_pixels;
        WordPixels::from_slice(&denoised_pixels(camera, padded, region, columns, place.row))
    }
}
