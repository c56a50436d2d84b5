// SPDX-License-Identifier: MIT OR Apache-2.0
//! The readout, by which the pixels or means of regions leave: the queue, the region that is held,
//! the word that is fetched, and the word on the ports.

use std::collections::VecDeque;

use foveate_design::RasterTiming;

use super::word::{Departing, Word};

/// Least number of edges from the start of one holding to the next.
const REST: u64 = 2;

/// A region that was lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Loss {
    pub(super) region: u32,
    /// The number of the frame of the region since reset.
    pub(super) frame: u64,
}

impl Loss {
    fn of(departing: &Departing) -> Self {
        Self { region: departing.region, frame: departing.frame }
    }
}

/// The result of an edge of the readout.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Read {
    /// True if a word was fetched.
    pub(super) has_fetched: bool,
    /// The region that was lost, if there was one.
    pub(super) lost: Option<Loss>,
}

/// The state of the readout.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Readout {
    /// Least number of edges from entering the queue to holding.
    queue_latency: u64,
    /// Regions that wait to leave, with the edges at which they entered the queue.
    queue: VecDeque<(u64, Departing)>,
    held: Option<Held>,
    /// The edge at which the readout last started to hold a region.
    started: Option<u64>,
    fetched: Option<Word>,
    shown: Option<Word>,
    /// Number of regions lost since reset.
    lost: u64,
}

/// The region that the readout holds.
#[derive(Clone, Debug, PartialEq)]
struct Held {
    departing: Departing,
    /// True if a word of the region has been fetched.
    has_begun: bool,
}

impl Held {
    fn fetch(&mut self) -> Option<Word> {
        self.has_begun = true;
        self.departing.words.pop_front()
    }

    fn is_fetched(&self) -> bool {
        self.departing.words.is_empty()
    }
}

impl Readout {
    pub(super) fn new(timing: &RasterTiming) -> Self {
        Self {
            queue_latency: timing.queue_latency.into(),
            queue: VecDeque::new(),
            held: None,
            started: None,
            fetched: None,
            shown: None,
            lost: 0,
        }
    }

    /// Appends a region to the queue at edge `now`.
    pub(super) fn enter(&mut self, now: u64, departing: Departing) {
        self.queue.push_back((now, departing));
    }

    /// Returns the word on the ports.
    pub(super) fn shown(&self) -> Option<&Word> {
        self.shown.as_ref()
    }

    /// Returns the word that was fetched at the last step.
    pub(super) fn fetched(&self) -> Option<&Word> {
        self.fetched.as_ref()
    }

    /// Returns the number of regions lost since reset.
    pub(super) fn lost(&self) -> u64 {
        self.lost
    }

    /// Returns true if the readout holds a region of a row below `fresh` and has fetched a word of
    /// it.
    pub(super) fn has_begun_below(&self, fresh: u64) -> bool {
        self.held.as_ref().is_some_and(|held| held.departing.row < fresh && held.has_begun)
    }

    /// Returns true if nothing is left to leave.
    pub(super) fn is_empty(&self) -> bool {
        let on_the_way = self.fetched.is_some() || self.shown.is_some();
        self.queue.is_empty() && self.held.is_none() && !on_the_way
    }

    /// Applies edge `now`. `sink_takes` is true if the sink takes a word. Rows of regions below
    /// `fresh` are stale.
    pub(super) fn step(&mut self, now: u64, sink_takes: bool, fresh: u64) -> Read {
        let mut may_start = self.held.is_none();
        let stale = self.held.take_if(|held| held.departing.row < fresh);
        let lost = stale.as_ref().map(|held| Loss::of(&held.departing));
        let mut read = Read { has_fetched: false, lost };
        if stale.is_some_and(|held| held.has_begun) {
            self.abort();
        }
        if self.shown.is_none() || sink_takes {
            self.shown = self.fetched.take();
            self.fetched = self.held.as_mut().and_then(Held::fetch);
            read.has_fetched = self.fetched.is_some();
            may_start |= self.held.take_if(|held| held.is_fetched()).is_some();
        }
        if may_start && let Some(departing) = self.next(now) {
            self.started = Some(now);
            if departing.row < fresh {
                read.lost = Some(Loss::of(&departing));
            } else {
                self.held = Some(Held { departing, has_begun: false });
            }
        }
        self.lost += u64::from(read.lost.is_some());
        read
    }

    /// Marks the word that was fetched last as the last of a region that is lost in the middle.
    fn abort(&mut self) {
        if let Some(word) = &mut self.fetched {
            (word.is_last, word.is_aborted) = (true, true);
        }
    }

    /// Removes and returns the oldest region of the queue, if it may be held now.
    fn next(&mut self, now: u64) -> Option<Departing> {
        let has_rested = self.started.is_none_or(|started| now >= started + REST);
        let is_due =
            self.queue.front().is_some_and(|(entered, _)| now >= entered + self.queue_latency);
        let next = (has_rested && is_due).then(|| self.queue.pop_front()).flatten();
        next.map(|(_, departing)| departing)
    }
}
