// SPDX-License-Identifier: MIT OR Apache-2.0
//! The readout, by which the pixels or means of regions leave: the queue, the region that is held,
//! the word that is fetched, and the word on the ports.

use std::collections::VecDeque;

use foveate_design::RasterTiming;

use super::forward_word::{DepartingRegion, ForwardWord};

/// Least number of edges from the start of one holding to the next.
const HOLD_INTERVAL: u64 = 2;

/// A region that was lost.
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
    /// The region that was lost, if there was one.
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
