// SPDX-License-Identifier: MIT OR Apache-2.0
//! The two streams of a core with an external frame store: the references that it takes, and the
//! words that it stores. Both events are a fixed number of clocks after a word has come to the
//! tail.

use foveate_design::{Camera, RasterDesign, RasterTiming};
use foveate_frame::Frame;

use super::advances::Place;
use super::decisions::Complete;
use super::due::{Due, take_due};
use crate::denoise::denoised_run;
use crate::region::black_padded;

/// The state of the two streams.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outside {
    camera: Camera,
    timing: RasterTiming,
    /// Words whose references have not been taken yet, in order, with the edges at which they are
    /// due.
    asking: Due<Asking>,
    /// Words that have not been stored yet, in order, with the edges at which they are due.
    storing: Due<Stored>,
    /// The references of the frame in the tail, as they were taken.
    references: Frame,
    /// Number of frames whose first word has come to the tail since reset.
    frames: u64,
    /// True if a reference was taken that was not valid.
    underrun: bool,
}

/// A word whose reference is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Asking {
    place: Place,
    /// True in all frames except the first.
    has_reference: bool,
    /// The region whose last word this is, if it is one.
    complete: Option<Complete>,
}

/// A word on its way to the store.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Stored {
    /// The scored pixels of the word.
    pub(super) pixels: Vec<u16>,
    /// True if the word is the last of its row.
    pub(super) is_last: bool,
}

impl Outside {
    pub(super) fn new(design: RasterDesign<'_>) -> Self {
        Self {
            timing: RasterTiming::of(design),
            asking: Due::new(),
            storing: Due::new(),
            references: black_padded(&design),
            frames: 0,
            underrun: false,
            camera: design.camera().clone(),
        }
    }

    /// Resets the streams: nothing is under way, and the next frame is the first.
    pub(super) fn forget(&mut self) {
        self.asking.clear();
        self.storing.clear();
        (self.frames, self.underrun) = (0, false);
    }

    /// Records a word that comes to the tail at edge `now`. `complete` is the region whose last
    /// word it is, if it is one.
    pub(super) fn come(
        &mut self,
        now: u64,
        place: Place,
        complete: Option<Complete>,
        padded: &Frame,
    ) {
        self.frames += u64::from(place == Place { row: 0, column: 0 });
        let asking = Asking { place, has_reference: self.frames > 1, complete };
        self.asking.push_back((now + u64::from(self.timing.lookup_latency), asking));
        let stored = Stored {
            pixels: self.scored(place, padded),
            is_last: place.column == self.timing.row_words - 1,
        };
        self.storing.push_back((now + u64::from(self.timing.store_latency), stored));
    }

    /// Applies edge `now`, at which the port shows the word `port`. If a reference is due, the word
    /// is taken. Returns the region that has all of its references from now on, if there is one.
    pub(super) fn take(&mut self, now: u64, valid: bool, port: &[u16]) -> Option<Complete> {
        let asking = take_due(&mut self.asking, now)?;
        if asking.has_reference {
            let left = asking.place.column * self.timing.word_pixels;
            self.references.write(left, asking.place.row, port);
            self.underrun |= !valid;
        }
        asking.complete
    }

    /// Returns the word that is on the store port after edge `now`, or `None`.
    pub(super) fn store(&mut self, now: u64) -> Option<Stored> {
        take_due(&mut self.storing, now)
    }

    /// Returns true if a reference is taken at the edge after `now`.
    pub(super) fn asks_after(&self, now: u64) -> bool {
        self.asking.front().is_some_and(|(due, asking)| *due == now + 1 && asking.has_reference)
    }

    /// Returns true if a region waits for the reference of its last word.
    pub(super) fn is_asking(&self) -> bool {
        self.asking.iter().any(|(_, asking)| asking.complete.is_some())
    }

    /// Returns the references as they were taken.
    pub(super) fn references(&self) -> &Frame {
        &self.references
    }

    pub(super) fn underrun(&self) -> bool {
        self.underrun
    }

    /// Returns the scored pixels of a word.
    fn scored(&self, place: Place, padded: &Frame) -> Vec<u16> {
        let Self { camera, timing, .. } = self;
        let region = place.row / camera.region_size() * camera.columns()
            + place.column / timing.region_row_words;
        let left = place.column * timing.word_pixels;
        denoised_run(camera, padded, region, left..left + timing.word_pixels, place.row)
    }
}
