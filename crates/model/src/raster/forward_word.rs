// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words of a region that leaves: its pixels, or the means of its blocks.

use std::collections::VecDeque;

use foveate_design::{Camera, Periphery, RegionAction};

use super::decisions::{DecidedRasterRegion, ScoredRasterRegion};
use crate::conversions::index;
use crate::periphery::first_position_of_block;

/// A word on its way to the forward ports.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ForwardWord {
    pub(super) region: u32,
    /// The number of the frame of the region since reset.
    pub(super) frame: u64,
    /// The number, in the region, of the first pixel of the word or of its block.
    pub(super) position: u32,
    /// The pixels on the port.
    pub(super) pixels: Vec<u16>,
    /// The scored pixels, which become the reference. They are empty for a mean.
    pub(super) scored: Vec<u16>,
    /// True if the word is the mean of a block.
    pub(super) is_mean: bool,
    /// True if no other word of the region follows.
    pub(super) is_last: bool,
    /// True if no other word follows because the region was lost.
    pub(super) is_aborted: bool,
}

/// A region that leaves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DepartingRegion {
    /// The number of the region.
    pub(super) region: u32,
    /// The number of the row of regions, counted through all frames since reset.
    pub(super) row: u64,
    /// The number of the frame since reset.
    pub(super) frame: u64,
    /// The words that have not been fetched yet, in order.
    pub(super) words: VecDeque<ForwardWord>,
}

impl DepartingRegion {
    /// Makes the words, of `word_pixels` pixels each, of a region that was decided.
    pub(super) fn from_decided(
        decided: &DecidedRasterRegion,
        camera: &Camera,
        word_pixels: u32,
    ) -> Self {
        let DecidedRasterRegion { scored_region, action } = decided;
        let mut words = match (action, camera.periphery()) {
            (RegionAction::Forward, _) => pixel_words(scored_region, word_pixels),
            (RegionAction::Summarize, Some(periphery)) => {
                mean_words(scored_region, periphery, word_pixels)
            }
            (RegionAction::Summarize, None) | (RegionAction::Hold | RegionAction::Blank, _) => {
                VecDeque::new()
            }
        };
        if let Some(last) = words.back_mut() {
            last.is_last = true;
        }
        Self {
            region: scored_region.region,
            row: scored_region.row,
            frame: scored_region.frame,
            words,
        }
    }
}

fn pixel_words(scored_region: &ScoredRasterRegion, word_pixels: u32) -> VecDeque<ForwardWord> {
    let size = index(word_pixels);
    let words =
        scored_region.payload.chunks_exact(size).zip(scored_region.scored.chunks_exact(size));
    let positions = (0..).step_by(size);
    let word = |((pixels, scored), position): ((&[u16], &[u16]), u32)| ForwardWord {
        pixels: pixels.to_vec(),
        scored: scored.to_vec(),
        is_mean: false,
        ..empty_word(scored_region, position)
    };
    words.zip(positions).map(word).collect()
}

fn mean_words(
    scored_region: &ScoredRasterRegion,
    periphery: &Periphery,
    word_pixels: u32,
) -> VecDeque<ForwardWord> {
    let word = |(&mean, block): (&u16, u32)| ForwardWord {
        pixels: vec![mean; index(word_pixels)],
        is_mean: true,
        ..empty_word(scored_region, first_position_of_block(periphery, block))
    };
    scored_region.means.iter().zip(0..).map(word).collect()
}

/// Makes a word of a region without pixels.
fn empty_word(scored_region: &ScoredRasterRegion, position: u32) -> ForwardWord {
    ForwardWord {
        region: scored_region.region,
        frame: scored_region.frame,
        position,
        pixels: Vec::new(),
        scored: Vec::new(),
        is_mean: false,
        is_last: false,
        is_aborted: false,
    }
}
