// SPDX-License-Identifier: MIT OR Apache-2.0
//! The words of a region that leaves: its pixels, or the means of its blocks.

use std::collections::VecDeque;

use foveate_design::{Action, Camera, Periphery};

use super::decisions::{Decided, Judged};
use crate::number::index;
use crate::periphery::first_of_block;

/// A word on its way to the forward ports.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Word {
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
pub(super) struct Departing {
    /// The number of the region.
    pub(super) region: u32,
    /// The number of the row of regions, counted through all frames since reset.
    pub(super) row: u64,
    /// The number of the frame since reset.
    pub(super) frame: u64,
    /// The words that have not been fetched yet, in order.
    pub(super) words: VecDeque<Word>,
}

impl Departing {
    /// Makes the words, of `word_pixels` pixels each, of a region that was decided.
    pub(super) fn of(decided: &Decided, camera: &Camera, word_pixels: u32) -> Self {
        let Decided { judged, action } = decided;
        let mut words = match (action, camera.periphery()) {
            (Action::Forward, _) => pixels(judged, word_pixels),
            (Action::Summarize, Some(periphery)) => means(judged, periphery, word_pixels),
            (Action::Summarize, None) | (Action::Hold | Action::Blank, _) => VecDeque::new(),
        };
        if let Some(last) = words.back_mut() {
            last.is_last = true;
        }
        Self { region: judged.region, row: judged.row, frame: judged.frame, words }
    }
}

fn pixels(judged: &Judged, word_pixels: u32) -> VecDeque<Word> {
    let size = index(word_pixels);
    let words = judged.payload.chunks_exact(size).zip(judged.scored.chunks_exact(size));
    let positions = (0..).step_by(size);
    let word = |((pixels, scored), position): ((&[u16], &[u16]), u32)| Word {
        pixels: pixels.to_vec(),
        scored: scored.to_vec(),
        is_mean: false,
        ..blank(judged, position)
    };
    words.zip(positions).map(word).collect()
}

fn means(judged: &Judged, periphery: &Periphery, word_pixels: u32) -> VecDeque<Word> {
    let word = |(&mean, block): (&u16, u32)| Word {
        pixels: vec![mean; index(word_pixels)],
        is_mean: true,
        ..blank(judged, first_of_block(periphery, block))
    };
    judged.means.iter().zip(0..).map(word).collect()
}

/// Makes a word of a region without pixels.
fn blank(judged: &Judged, position: u32) -> Word {
    Word {
        region: judged.region,
        frame: judged.frame,
        position,
        pixels: Vec::new(),
        scored: Vec::new(),
        is_mean: false,
        is_last: false,
        is_aborted: false,
    }
}
