// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words of a region that leaves: its pixels, or the means of its blocks.

use foveate_camera::{Camera, Periphery, RegionAction};
use foveate_design::RasterTiming;

use super::decisions::{DecidedRasterRegion, ScoredRasterRegion};
use super::word_pixels::WordPixels;
use crate::conversions::index;
use crate::periphery::first_position_of_block;

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

    /// Returns the number of the region.
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

    /// Fetches the next word.
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
