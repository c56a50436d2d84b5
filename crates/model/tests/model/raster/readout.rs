// SPDX-License-Identifier: MIT OR Apache-2.0
//! The readout of `docs/raster.md`, computed edge by edge from the complete history.

/// A region that leaves, with the edges of its events.
#[derive(Clone, Debug)]
pub(crate) struct RegionReadout {
    pub(crate) frame: usize,
    pub(crate) region: i64,
    pub(crate) words: i64,
    /// The edge after which its decision is on the ports.
    decided: i64,
    /// The edge from which on it is stale, or the largest number while that is not known.
    pub(crate) stale: i64,
    held: Option<i64>,
    fetched: Vec<i64>,
    pub(crate) lost: Option<i64>,
}

impl RegionReadout {
    fn is_fully_fetched(&self) -> bool {
        self.fetched.len() as i64 == self.words
    }

    fn is_held_before(&self, edge: i64) -> bool {
        let is_held = self.held.is_some_and(|held| held < edge);
        is_held && self.lost.is_none() && !self.is_fully_fetched()
    }

    /// Returns true if the word ends the region because the region was lost: it is the last word
    /// that was fetched.
    pub(crate) fn is_abort(&self, word: i64) -> bool {
        self.lost.is_some() && word + 1 == self.fetched.len() as i64
    }
}

/// A word: the index of its region in the history, and its number in the region.
pub(crate) type ReadoutWord = (usize, i64);

#[derive(Clone, Debug, Default)]
pub(crate) struct ReadoutHistory {
    pub(crate) regions: Vec<RegionReadout>,
    /// Least number of edges from entering the queue to holding.
    queue_latency: i64,
    /// The word on the ports after every edge.
    pub(crate) shown: Vec<Option<ReadoutWord>>,
    /// Number of regions that had been lost after every edge.
    pub(crate) lost_counts: Vec<i64>,
    /// The word that was fetched at the last step.
    fetched: Option<ReadoutWord>,
}

impl ReadoutHistory {
    pub(crate) fn new(deep: bool) -> Self {
        Self {
            queue_latency: if deep { 3 } else { 2 },
            shown: vec![None],
            lost_counts: vec![0],
            ..Self::default()
        }
    }

    /// Appends a region of which `words` words leave. Its decision is on the ports after edge
    /// `decided`.
    pub(crate) fn enqueue(&mut self, frame: usize, region: i64, words: i64, decided: i64) {
        self.regions.push(RegionReadout {
            frame,
            region,
            words,
            decided,
            stale: i64::MAX,
            held: None,
            fetched: Vec::new(),
            lost: None,
        });
    }

    pub(crate) fn process_edge(&mut self, edge: i64, sink: bool) {
        let before = self.shown[edge as usize - 1];
        let steps = before.is_none() || sink;
        let held = self.regions.iter().position(|reading| reading.is_held_before(edge));
        let mut may_hold = held.is_none();
        let mut fetched = None;
        if let Some(number) = held {
            let reading = &mut self.regions[number];
            if reading.stale <= edge {
                reading.lost = Some(edge);
            } else if steps {
                fetched = Some((number, reading.fetched.len() as i64));
                reading.fetched.push(edge);
                may_hold = reading.is_fully_fetched();
            }
        }
        if may_hold {
            self.hold_next(edge);
        }
        self.shown.push(if steps { self.fetched } else { before });
        if steps {
            self.fetched = fetched;
        }
        let lost = self.regions.iter().filter(|reading| reading.lost.is_some()).count();
        self.lost_counts.push(lost as i64);
    }

    fn hold_next(&mut self, edge: i64) {
        // A region that is lost instead of being held counts as held for the rule of two edges.
        let starts = self.regions.iter().filter_map(|reading| reading.held);
        let has_rested = starts.max().is_none_or(|last| edge - last >= 2);
        let next = self.regions.iter_mut().find(|reading| reading.held.is_none());
        let Some(reading) =
            next.filter(|reading| has_rested && edge >= reading.decided + 1 + self.queue_latency)
        else {
            return;
        };
        reading.held = Some(edge);
        if reading.stale <= edge {
            reading.lost = Some(edge);
        }
    }

    pub(crate) fn lost_at(&self, edge: i64) -> Vec<&RegionReadout> {
        self.regions.iter().filter(|reading| reading.lost == Some(edge)).collect()
    }

    /// Returns true if a region is pending after the last edge that was processed.
    pub(crate) fn is_pending(&self) -> bool {
        let is_shown = self.shown.last().is_some_and(Option::is_some);
        let is_left =
            |reading: &RegionReadout| reading.lost.is_none() && !reading.is_fully_fetched();
        self.regions.iter().any(is_left) || self.fetched.is_some() || is_shown
    }
}
