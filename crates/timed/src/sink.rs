// SPDX-License-Identifier: MIT OR Apache-2.0
//! The receiver of a core's forwarded words, which may stall ([`Sink`]). A [`SinkPattern`]
//! describes it, so that any number of equal sinks can be made.

use super::delivery::NEVER;
use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

/// A sink of forwarded words. A stall is a range of edges at which `forward_ready_i` is 0. Only a
/// raster core waits for its sink.
pub trait Sink: Debug + Send {
    /// Returns the first stall that ends after edge `from`, or `None` if the sink is ready from
    /// there on.
    fn next_stall(&mut self, from: u64) -> Option<Range<u64>>;

    /// Returns the first edge from `from` on at which the sink is ready.
    fn next_ready(&mut self, from: u64) -> u64 {
        let mut edge = from;
        while let Some(stall) = self.next_stall(edge)
            && (stall.start..stall.end.min(NEVER)).contains(&edge)
        {
            edge = stall.end.min(NEVER);
        }
        edge
    }
}

/// A sink that is always ready.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadySink;

impl Sink for ReadySink {
    fn next_stall(&mut self, _from: u64) -> Option<Range<u64>> {
        None
    }
}

/// A sink that is ready at a constant rate, at edges that are as evenly spaced as possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RateSink {
    ready: u64,
    clocks: u64,
}

impl RateSink {
    /// Makes a sink that is ready at `ready` of every `clocks` edges. It is always ready if `ready`
    /// is not below `clocks`, and never if `ready` is 0.
    #[must_use]
    pub fn new(ready: u32, clocks: u32) -> Self {
        Self { ready: ready.min(clocks).into(), clocks: clocks.max(1).into() }
    }
}

impl Sink for RateSink {
    /// The sink is ready at the edges e with `e * ready mod clocks < ready`.
    fn next_stall(&mut self, from: u64) -> Option<Range<u64>> {
        let Self { ready, clocks } = *self;
        match ready {
            0 => return Some(from..NEVER),
            _ if ready == clocks => return None,
            _ => {}
        }
        let phase = from % clocks * ready % clocks;
        // Each ready edge takes the phase back by `clocks - ready` until none is left to take.
        let pause = clocks - ready;
        let (start, phase) = if phase < ready {
            let readies = phase / pause + 1;
            (from + readies, phase + ready - (readies - 1) * pause)
        } else {
            (from, phase)
        };
        Some(start..start + (clocks - phase).div_ceil(ready))
    }
}

/// A sink with a list of stalls.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StallList {
    stalls: Vec<Range<u64>>,
}

impl StallList {
    /// Makes a sink that stalls at these ranges of edges, which are in ascending order.
    #[must_use]
    pub fn new(stalls: Vec<Range<u64>>) -> Self {
        Self { stalls }
    }
}

impl Sink for StallList {
    fn next_stall(&mut self, from: u64) -> Option<Range<u64>> {
        let over = self.stalls.partition_point(|stall| stall.end <= from);
        self.stalls.get(over).cloned()
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the edges up to 200 at which a sink is ready, by its stalls.
    fn ready_edges(mut sink: impl Sink) -> Vec<u64> {
        let mut edges = Vec::new();
        let mut edge = 0;
        while edge < 200 {
            edge = sink.next_ready(edge);
            edges.push(edge);
            edge += 1;
        }
        edges.retain(|&edge| edge < 200);
        edges
    }

    #[test]
    fn a_rate_is_a_formula_for_its_stalls() {
        for clocks in 1..=13 {
            for ready in 0..=clocks {
                let expected: Vec<u64> =
                    (0..200).filter(|edge| edge * ready % clocks < ready).collect();
                let sink =
                    RateSink::new(u32::try_from(ready).unwrap(), u32::try_from(clocks).unwrap());
                assert_eq!(ready_edges(sink), expected, "{ready} of {clocks}");
            }
        }
    }

    #[test]
    fn a_list_stalls_where_it_says() {
        let sink = StallList::new(vec![0..2, 5..6, 6..9, 50..190]);
        let stalled = |edge: &u64| matches!(edge, 0..2 | 5..9 | 50..190);
        let expected: Vec<u64> = (0..200).filter(|edge| !stalled(edge)).collect();
        assert_eq!(ready_edges(sink), expected);
        assert_eq!(ready_edges(ReadySink).len(), 200);
    }
}
