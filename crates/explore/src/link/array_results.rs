// SPDX-License-Identifier: MIT OR Apache-2.0
//! The results of the generated array over a clip.

use serde::{Deserialize, Serialize};

use crate::link::LinkUnit;

/// The results of the generated array over a clip.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArrayResults {
    /// The units that the array gives to the link.
    pub units: Vec<LinkUnit>,
    /// The most clocks that the array adds to a time of a unit after the pixels that it waits for
    /// have been read.
    pub added_clocks: u64,
    /// The figures without a buffer; `None` for an array that does not wait for its sink.
    pub unbuffered: Option<UnbufferedFigures>,
}

/// The figures of an array that gives its words to the link without a buffer between them. The link
/// takes words as fast as it can carry them. Decisions take no time of the link.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct UnbufferedFigures {
    /// The clock of the array in Hz: the given one, or the slowest one that keeps up.
    pub clock_hz: u64,
    /// The number of regions that are lost because the link is too slow for them.
    pub lost_regions: u64,
    /// The numbers of the frames of these regions, in ascending order.
    pub frames_with_losses: Vec<u64>,
    /// The longest time from reading the oldest pixel of a row of regions until the link takes its
    /// last word, in ns.
    pub last_word_ns: u64,
}
