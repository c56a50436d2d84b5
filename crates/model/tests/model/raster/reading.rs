// SPDX-License-Identifier: MIT OR Apache-2.0
//! The readout of `docs/raster.md`, looked up edge by edge in the complete history of what was read.

/// A region that leaves: what happened to it, by edge.
#[derive(Clone, Debug)]
pub(crate) struct Reading {
    pub(crate) frame: usize,
    pub(crate) region: i64,
    pub(crate) words: i64,
    /// The edge after which its decision stands on the ports.
    decided: i64,
    /// The edge from which on it is stale, once that is known.
    pub(crate) stale: i64,
    held: Option<i64>,
    fetched: Vec<i64>,
    pub(crate) lost: Option<i64>,
}

impl Reading {
    fn is_fetched(&self) -> bool {
        self.fetched.len() as i64 == self.words
    }

    fn is_held_before(&self, edge: i64) -> bool {
        let is_held = self.held.is_some_and(|held| held < edge);
        is_held && self.lost.is_none() && !self.is_fetched()
    }

    /// Whether that word ends the region because it was lost: it is the last that was fetched.
    pub(crate) fn is_abort(&self, word: i64) -> bool {
        self.lost.is_some() && word + 1 == self.fetched.len() as i64
    }
}

/// A word: the number of its reading, and its number in its region.
pub(crate) type Word = (usize, i64);

#[derive(Clone, Debug, Default)]
pub(crate) struct Readings {
    pub(crate) all: Vec<Reading>,
    /// Edges from one holding to the next, at least.
    rest: i64,
    /// Edges from entering the queue to holding, at least.
    wait: i64,
    /// The word on the ports after every edge.
    pub(crate) shown: Vec<Option<Word>>,
    /// Regions that had been lost after every edge.
    pub(crate) lost: Vec<i64>,
    /// The word that was fetched at the last step.
    fetched: Option<Word>,
}

impl Readings {
    /// `wrong` is by how many clocks resting is misread.
    pub(crate) fn new(deep: bool, wrong: i64) -> Self {
        let (rest, wait) = (2 + wrong, if deep { 3 } else { 2 } + wrong);
        Self { rest, wait, shown: vec![None], lost: vec![0], ..Self::default() }
    }

    /// So many words of a region leave; its decision is on the ports after that edge.
    pub(crate) fn enter(&mut self, frame: usize, region: i64, words: i64, decided: i64) {
        let (held, fetched) = (None, Vec::new());
        let (stale, lost) = (i64::MAX, None);
        self.all.push(Reading { frame, region, words, decided, stale, held, fetched, lost });
    }

    /// The next edge.
    pub(crate) fn edge(&mut self, edge: i64, sink: bool) {
        let before = self.shown[edge as usize - 1];
        let steps = before.is_none() || sink;
        let held = self.all.iter().position(|reading| reading.is_held_before(edge));
        let mut may_hold = held.is_none();
        let mut fetched = None;
        if let Some(number) = held {
            let reading = &mut self.all[number];
            if reading.stale <= edge {
                reading.lost = Some(edge);
            } else if steps {
                fetched = Some((number, reading.fetched.len() as i64));
                reading.fetched.push(edge);
                may_hold = reading.is_fetched();
            }
        }
        if may_hold {
            self.hold(edge);
        }
        self.shown.push(if steps { self.fetched } else { before });
        if steps {
            self.fetched = fetched;
        }
        let lost = self.all.iter().filter(|reading| reading.lost.is_some()).count();
        self.lost.push(lost as i64);
    }

    fn hold(&mut self, edge: i64) {
        // Lost instead of held is as good as held.
        let starts = self.all.iter().filter_map(|reading| reading.held);
        let has_rested = starts.max().is_none_or(|last| edge - last >= self.rest);
        let next = self.all.iter_mut().find(|reading| reading.held.is_none());
        let Some(reading) =
            next.filter(|reading| has_rested && edge >= reading.decided + 1 + self.wait)
        else {
            return;
        };
        reading.held = Some(edge);
        if reading.stale <= edge {
            reading.lost = Some(edge);
        }
    }

    /// The regions that are lost at that edge.
    pub(crate) fn lost_at(&self, edge: i64) -> Vec<&Reading> {
        self.all.iter().filter(|reading| reading.lost == Some(edge)).collect()
    }

    /// Whether a region is pending after that edge, the last that was looked at.
    pub(crate) fn is_pending(&self) -> bool {
        let is_shown = self.shown.last().is_some_and(Option::is_some);
        let is_left = |reading: &Reading| reading.lost.is_none() && !reading.is_fetched();
        self.all.iter().any(is_left) || self.fetched.is_some() || is_shown
    }
}
