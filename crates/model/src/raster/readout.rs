// SPDX-License-Identifier: MIT OR Apache-2.0
//! The readout ([`Readout`]), by which the pixels or means of regions leave: the queue, the
//! region that is held, the word that is fetched, and the word on the ports. A
//! [`DepartingRegion`] leaves word by word; the pixels of a word are stored without an
//! allocation ([`WordPixels`]).

use super::decisions::{DecidedRasterRegion, ScoredRasterRegion};
use crate::conversions::index;
use crate::periphery::first_position_of_block;
use foveate_camera::{Camera, Periphery, RegionAction};
use foveate_design::RasterTiming;
use std::collections::VecDeque;

/// Least number of edges from the start of one holding to the next.
const HOLD_INTERVAL: u64 = 2;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LostRegion {
    pub(super) region: u32,
    /// The number of the frame of the region since reset.
    pub(super) frame: u64,
}

impl LostRegion {
    fn from_departing(departing: &DepartingRegion) -> Self {
        Self { region: departing.region(), frame: departing.frame() }
    }
}

/// The result of an edge of the readout.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ReadoutStep {
    /// True if a word was fetched.
    pub(super) has_fetched: bool,
    pub(super) lost: Option<LostRegion>,
}

/// The state of the readout.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Readout {
    /// Least number of edges from entering the queue to holding.
    queue_latency: u64,
    /// Regions that wait to leave, with the edges at which they entered the queue.
    queue: VecDeque<(u64, DepartingRegion)>,
    /// The region that the readout holds.
    held: Option<DepartingRegion>,
    /// The edge at which the readout last started to hold a region.
    last_hold: Option<u64>,
    fetched_word: Option<ForwardWord>,
    shown_word: Option<ForwardWord>,
    /// Number of regions lost since reset.
    lost_count: u64,
}

impl Readout {
    pub(super) fn new(timing: &RasterTiming) -> Self {
        Self {
            queue_latency: timing.queue_latency.into(),
            queue: VecDeque::new(),
            held: None,
            last_hold: None,
            fetched_word: None,
            shown_word: None,
            lost_count: 0,
        }
    }

    /// Appends a region to the queue at edge `now`.
    pub(super) fn enqueue(&mut self, now: u64, departing: DepartingRegion) {
        self.queue.push_back((now, departing));
    }

    /// Returns the word on the ports.
    pub(super) fn shown_word(&self) -> Option<&ForwardWord> {
        self.shown_word.as_ref()
    }

    /// Returns the word that was fetched at the last step.
    pub(super) fn fetched_word(&self) -> Option<&ForwardWord> {
        self.fetched_word.as_ref()
    }

    /// Returns the number of regions lost since reset.
    pub(super) fn lost_count(&self) -> u64 {
        self.lost_count
    }

    /// Returns true if the readout holds a region of a row below `fresh` and has fetched a word of
    /// it.
    pub(super) fn has_partial_region_below(&self, fresh: u64) -> bool {
        self.held.as_ref().is_some_and(|held| held.row() < fresh && !held.is_whole())
    }

    /// Returns true if nothing is left to leave.
    pub(super) fn is_empty(&self) -> bool {
        let on_the_way = self.fetched_word.is_some() || self.shown_word.is_some();
        self.queue.is_empty() && self.held.is_none() && !on_the_way
    }

    /// Applies edge `now`. `sink_takes` is true if the sink takes a word. Rows of regions below
    /// `fresh` are stale.
    pub(super) fn step(&mut self, now: u64, sink_takes: bool, fresh: u64) -> ReadoutStep {
        let mut may_start = self.held.is_none();
        let mut read = ReadoutStep::default();
        if let Some(stale) = self.held.take_if(|held| held.row() < fresh) {
            read.lost = Some(LostRegion::from_departing(&stale));
            if !stale.is_whole() {
                self.mark_abort();
            }
        }
        if self.shown_word.is_none() || sink_takes {
            self.shown_word = self.fetched_word.take();
            self.fetched_word = self.held.as_mut().map(DepartingRegion::fetch_word);
            read.has_fetched = self.fetched_word.is_some();
            may_start |= self.held.take_if(|held| held.is_fully_fetched()).is_some();
        }
        if may_start && let Some(departing) = self.next_region(now) {
            self.last_hold = Some(now);
            if departing.row() < fresh {
                read.lost = Some(LostRegion::from_departing(&departing));
            } else {
                self.held = Some(departing);
            }
        }
        self.lost_count += u64::from(read.lost.is_some());
        read
    }

    /// Marks the word that was fetched last as the last of a region that is lost in the middle.
    fn mark_abort(&mut self) {
        if let Some(word) = &mut self.fetched_word {
            (word.is_last, word.is_aborted) = (true, true);
        }
    }

    /// Removes and returns the oldest region of the queue, if it may be held now.
    fn next_region(&mut self, now: u64) -> Option<DepartingRegion> {
        let has_rested = self.last_hold.is_none_or(|started| now >= started + HOLD_INTERVAL);
        let is_due =
            self.queue.front().is_some_and(|(entered, _)| now >= entered + self.queue_latency);
        let next = (has_rested && is_due).then(|| self.queue.pop_front()).flatten();
        next.map(|(_, departing)| departing)
    }
}

/// A word on its way to the forward ports.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ForwardWord {
    pub(super) region: u32,
    /// The number of the frame of the region since reset.
    pub(super) frame: u64,
    /// The number, in the region, of the first pixel of the word or of its block.
    pub(super) position: u32,
    /// The pixels on the port.
    pub(super) pixels: WordPixels,
    /// The scored pixels, which become the reference. They are empty for a mean.
    pub(super) scored: WordPixels,
    /// True if the word is the mean of a block.
    pub(super) is_mean: bool,
    /// True if no other word of the region follows.
    pub(super) is_last: bool,
    /// True if no other word follows because the region was lost.
    pub(super) is_aborted: bool,
}

/// A region that leaves, word by word.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DepartingRegion {
    scored_region: Box<ScoredRasterRegion>,
    content: DepartingContent,
    /// Number of pixels of a word, K.
    word_pixels: u32,
    /// Number of words of the region that leave.
    words: u32,
    /// Number of words that have been fetched.
    fetched_words: u32,
}

/// The content of the words of a region that leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum DepartingContent {
    Pixels,
    /// The means of the blocks, one in each word.
    Means(Periphery),
}

impl DepartingRegion {
    /// Makes the region that leaves of a region that was decided, or returns `None` if its action
    /// sends nothing.
    pub(super) fn from_decided(
        decided: DecidedRasterRegion,
        camera: &Camera,
        timing: &RasterTiming,
    ) -> Option<Self> {
        let DecidedRasterRegion { scored_region, action } = decided;
        let words = timing.words_sent(action)?;
        let content = match action {
            RegionAction::Forward => DepartingContent::Pixels,
            RegionAction::Summarize => DepartingContent::Means(*camera.periphery()?),
            RegionAction::Hold | RegionAction::Blank => return None,
        };
        let word_pixels = timing.word_pixels;
        Some(Self { scored_region, content, word_pixels, words, fetched_words: 0 })
    }

    pub(super) fn region(&self) -> u32 {
        self.scored_region.region
    }

    /// Returns the number of the row of regions, counted through all frames since reset.
    pub(super) fn row(&self) -> u64 {
        self.scored_region.row
    }

    /// Returns the number of the frame since reset.
    pub(super) fn frame(&self) -> u64 {
        self.scored_region.frame
    }

    /// Returns true if no word has been fetched.
    pub(super) fn is_whole(&self) -> bool {
        self.fetched_words == 0
    }

    /// Returns true if all words have been fetched.
    pub(super) fn is_fully_fetched(&self) -> bool {
        self.fetched_words == self.words
    }

    #[inline] // This is called at every clock.
    pub(super) fn fetch_word(&mut self) -> ForwardWord {
        let number = self.fetched_words;
        self.fetched_words += 1;
        let ScoredRasterRegion { region, frame, scored, payload, means, .. } = &*self.scored_region;
        let word_at = |pixels: &[u16], position| {
            WordPixels::from_slice(&pixels[index(position)..][..index(self.word_pixels)])
        };
        let (position, pixels, scored) = match &self.content {
            DepartingContent::Pixels => {
                let position = number * self.word_pixels;
                (position, word_at(payload, position), word_at(scored, position))
            }
            DepartingContent::Means(periphery) => {
                let mean = WordPixels::repeat(means[index(number)], index(self.word_pixels));
                (first_position_of_block(periphery, number), mean, WordPixels::empty())
            }
        };
        ForwardWord {
            region: *region,
            frame: *frame,
            position,
            pixels,
            scored,
            is_mean: matches!(self.content, DepartingContent::Means(_)),
            is_last: self.is_fully_fetched(),
            is_aborted: false,
        }
    }
}

const MAX_WORD_PIXELS: usize = 4;

/// The pixels of a word, the left one first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct WordPixels {
    pixels: [u16; MAX_WORD_PIXELS],
    count: usize,
}

impl WordPixels {
    /// Makes a word without pixels.
    pub(super) fn empty() -> Self {
        Self { pixels: [0; MAX_WORD_PIXELS], count: 0 }
    }

    pub(super) fn from_slice(pixels: &[u16]) -> Self {
        let pixel = |place| pixels.get(place).copied().unwrap_or_default();
        Self { pixels: std::array::from_fn(pixel), count: pixels.len() }
    }

    /// Makes a word of `count` equal pixels.
    pub(super) fn repeat(pixel: u16, count: usize) -> Self {
        Self { pixels: [pixel; MAX_WORD_PIXELS], count }
    }

    pub(super) fn as_slice(&self) -> &[u16] {
        &self.pixels[..self.count]
    }
}
