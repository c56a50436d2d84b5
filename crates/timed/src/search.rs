// SPDX-License-Identifier: MIT OR Apache-2.0
//! The search for frames in the stream of beats, by the rules of `docs/sync.md`.

use foveate_pixels::FramePixels;

use crate::BeatOffer;
use crate::payload::KeptPixels;

/// The position of the stream between two deliveries.
#[derive(Debug)]
pub(crate) enum StreamState {
    /// No frame is under way. The core completes no frame from edge `idle_from` on.
    Seek {
        /// The first edge at which a beat that comes is not dropped because the core completes a
        /// frame.
        idle_from: u64,
    },
    /// A frame has just received its last beat.
    Start,
    /// A frame is under way, and the source has not delivered all of its beats.
    Inside(UnfinishedFrame),
}

/// A frame of which some beats were delivered.
#[derive(Debug)]
pub(crate) struct UnfinishedFrame {
    /// The pixels of the whole frame.
    pixels: KeptPixels,
    /// The pauses before its beats.
    pub(crate) offers: Vec<BeatOffer>,
    /// The number of beats that were delivered.
    pub(crate) beats: u64,
}

impl UnfinishedFrame {
    /// Makes a frame whose first `beats` beats are delivered with these pauses.
    pub(crate) fn new(pixels: FramePixels<'_>, offers: &[BeatOffer], beats: u64) -> Self {
        let mut frame = Self { pixels: KeptPixels::copy_of(pixels), offers: Vec::new(), beats: 0 };
        frame.append(offers, beats);
        frame
    }

    pub(crate) fn pixels(&self) -> FramePixels<'_> {
        self.pixels.borrow()
    }

    /// Appends the first `beats` beats of another delivery, with their pauses.
    pub(crate) fn append(&mut self, offers: &[BeatOffer], beats: u64) {
        let own = offers.iter().take_while(|offer| offer.beat < beats);
        let start = self.beats;
        self.offers.extend(own.map(|offer| BeatOffer { beat: start + offer.beat, ..*offer }));
        self.beats += beats;
    }

    /// Lets the next beat come not before an edge.
    pub(crate) fn delay_next(&mut self, clock: u64) {
        self.offers.push(BeatOffer { beat: self.beats, clock });
    }
}
