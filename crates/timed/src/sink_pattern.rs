// SPDX-License-Identifier: MIT OR Apache-2.0
//! The description of a sink, from which any number of equal sinks can be made.

use std::ops::Range;
use std::sync::Arc;

use crate::{RateSink, ReadySink, Sink, StallList};

/// When a sink takes words.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum SinkPattern {
    /// It takes a word at every clock.
    #[default]
    Always,
    /// It takes words at a constant rate, as [`RateSink`] does.
    Rate {
        /// The number of words that it can take in `clocks` clocks.
        words: u32,
        /// The number of clocks.
        clocks: u32,
    },
    /// It takes no word within these ranges of edges, which are in ascending order.
    Stalls(Arc<[Range<u64>]>),
}

impl SinkPattern {
    /// Returns the pattern of a sink that takes `words` words in `clocks` clocks, or `None` if it
    /// would take more than one word at a clock.
    #[must_use]
    pub fn from_rate(words: u32, clocks: u32) -> Option<Self> {
        (words <= clocks && clocks > 0).then_some(Self::Rate { words, clocks })
    }

    /// Makes a sink in the state at the first edge.
    #[must_use]
    pub fn sink(&self) -> Box<dyn Sink> {
        match self {
            Self::Always => Box::new(ReadySink),
            Self::Rate { words, clocks } => Box::new(RateSink::new(*words, *clocks)),
            Self::Stalls(stalls) => Box::new(StallList::new(stalls.to_vec())),
        }
    }
}
