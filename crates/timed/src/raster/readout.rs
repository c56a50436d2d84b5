// SPDX-License-Identifier: MIT OR Apache-2.0
//! The readout: the queue of regions that leave, and the clocks of their words.
//!
//! The words of all regions form one sequence. For its word k, let f be the edge at which it is
//! fetched, s the edge after which it is on the ports, and t the edge at which the sink takes it,
//! the first after s at which the sink is ready. If the readout started to hold the word's region
//! at edge h, the rules of `docs/raster.md` for steps become
//!
//! ```text
//! f(k) = s(k-1)                 if h < s(k-1), as for every word but the first of a region
//! f(k) = max(h + 1, t(k-1))     otherwise
//! s(k) = max(f(k) + 1, t(k-1))
//! ```
//!
//! So the words of a region follow each other at every clock, except where the sink stalls.

use std::collections::VecDeque;
use std::sync::Arc;

use foveate_design::RasterTiming;

use super::staleness::RowStaleness;
use crate::delivery::NEVER;
use crate::{RegionLoss, RegionRun, SentKind, SentValues, Sink, Transaction, WordRun};

/// A region that sends pixels or means.
#[derive(Clone, Debug)]
pub(super) struct SendingRegion {
    pub(super) region: u32,
    /// The number of the frame since reset.
    pub(super) frame: u64,
    /// The number of the row of regions since reset.
    pub(super) row: u64,
    pub(super) kind: SentKind,
    pub(super) words: u32,
    /// The edge at which it enters the queue.
    pub(super) entered: u64,
    /// A copy of what it sends, once the engine has taken the next frame.
    pub(super) copy: Option<Arc<[u16]>>,
}

#[derive(Clone, Copy, Debug)]
struct HoldState {
    /// The edge at which the readout started to hold it.
    since: u64,
    /// The number of its words that were fetched.
    fetched: u32,
}

/// A word that was fetched and is not on the ports yet, because the sink does not take the word
/// before it.
#[derive(Debug)]
struct FetchedWord {
    sender: SendingRegion,
    number: u32,
    /// The edge at which it was fetched, f.
    fetched: u64,
    is_aborted: bool,
}

/// The parts of the model that the readout uses.
pub(super) struct ReadoutContext<'a> {
    pub(super) staleness: &'a RowStaleness,
    pub(super) sink: &'a mut dyn Sink,
    pub(super) visit: &'a mut dyn FnMut(&Transaction<'_>),
    /// The values of regions without a copy.
    pub(super) values: Option<SentValues<'a>>,
    pub(super) word_pixels: u32,
    /// The regions that were lost.
    pub(super) losses: &'a mut Vec<u32>,
}

/// The readout and its queue.
#[derive(Debug)]
pub(super) struct Readout {
    queue_latency: u64,
    hold_interval: u64,
    /// The regions that have words to fetch, the oldest first.
    queue: VecDeque<SendingRegion>,
    held: Option<HoldState>,
    /// The first edge at which the readout may hold the next region, if that is in the queue.
    next_hold: u64,
    /// The word behind those that were shown, if it was fetched.
    fetched: Option<FetchedWord>,
    /// The edge after which the last word was on the ports, s.
    last_shown: Option<u64>,
    /// The edge at which the sink takes that word, t, once it is known.
    last_taken: Option<u64>,
}

impl Readout {
    pub(super) fn new(timing: &RasterTiming) -> Self {
        Self {
            queue_latency: timing.queue_latency.into(),
            hold_interval: timing.hold_interval.into(),
            queue: VecDeque::new(),
            held: None,
            next_hold: 0,
            fetched: None,
            last_shown: None,
            last_taken: None,
        }
    }

    pub(super) fn reset(&mut self) {
        self.queue.clear();
        (self.held, self.fetched) = (None, None);
        (self.next_hold, self.last_shown, self.last_taken) = (0, None, None);
    }

    pub(super) fn push(&mut self, sender: SendingRegion) {
        self.queue.push_back(sender);
    }

    /// Returns the regions with words that were not shown, the oldest first.
    pub(super) fn waiting(&mut self) -> impl Iterator<Item = &mut SendingRegion> {
        let fetched = self.fetched.iter_mut().map(|word| &mut word.sender);
        fetched.chain(&mut self.queue)
    }

    /// Returns the edge at which the sink takes the last word that was shown, or 0 if there was
    /// none.
    pub(super) fn last_taken(&mut self, sink: &mut dyn Sink) -> u64 {
        let Some(shown) = self.last_shown else { return 0 };
        *self.last_taken.get_or_insert_with(|| sink.next_ready(shown + 1))
    }

    /// Yields the words and losses before edge `end`.
    pub(super) fn run(&mut self, end: u64, context: &mut ReadoutContext<'_>) {
        loop {
            self.show_fetched(end, context);
            if !self.hold_next(end, context) || !self.fetch_words(end, context) {
                return;
            }
        }
    }

    /// Shows the word that waits behind the last one, if the sink takes that one before edge `end`.
    /// The held region can be lost before that.
    fn show_fetched(&mut self, end: u64, context: &mut ReadoutContext<'_>) {
        let taken = self.last_taken(context.sink);
        let Some(word) = &self.fetched else { return };
        let shown = taken.max(word.fetched + 1);
        if let (Some(_), Some(held)) = (self.held, self.queue.front()) {
            let stale = context.staleness.stale_from(held.row);
            if stale <= shown && stale < end {
                self.lose_held(stale, context);
            }
        }
        if let Some(word) = self.fetched.take_if(|_| shown < end) {
            context.send(&word.sender, shown, (word.number, 1), word.is_aborted);
            (self.last_shown, self.last_taken) = (Some(shown), None);
        }
    }

    /// Holds the oldest region of the queue if none is held. Regions that are stale by then are
    /// lost. Returns false if no region is held before edge `end`.
    fn hold_next(&mut self, end: u64, context: &mut ReadoutContext<'_>) -> bool {
        while self.held.is_none() {
            let Some(next) = self.queue.front() else { return false };
            let since = self.next_hold.max(next.entered + self.queue_latency);
            if since >= end {
                return false;
            }
            self.next_hold = since + self.hold_interval;
            if since >= context.staleness.stale_from(next.row) {
                context.lose(since, next);
                self.queue.pop_front();
            } else {
                self.held = Some(HoldState { since, fetched: 0 });
            }
        }
        true
    }

    /// Fetches the next words of the held region and shows them: one word, or as many as follow
    /// each other at every clock. Returns false if no more happens before edge `end`.
    fn fetch_words(&mut self, end: u64, context: &mut ReadoutContext<'_>) -> bool {
        let taken = self.last_taken(context.sink);
        let (Some(held), Some(sender)) = (self.held, self.queue.front()) else { return false };
        let fetched = match (&self.fetched, self.last_shown) {
            // The next word is fetched when this one is shown, which is not before `end`.
            (Some(word), _) => taken.max(word.fetched + 1),
            (None, Some(shown)) if held.since < shown => shown,
            (None, _) => taken.max(held.since + 1),
        };
        let stale = context.staleness.stale_from(sender.row);
        if fetched >= stale {
            let is_lost = stale < end;
            if is_lost {
                self.lose_held(stale, context);
            }
            return is_lost;
        }
        if fetched >= end {
            return false;
        }
        let shown = taken.max(fetched + 1);
        let left = sender.words - held.fetched;
        if shown >= end {
            let (sender, number) = (sender.clone(), held.fetched);
            self.fetched = Some(FetchedWord { sender, number, fetched, is_aborted: false });
            self.record_fetched(1, fetched);
            return true;
        }
        // From here on the sink takes a word at every clock, until it stalls.
        let stall = context.sink.next_stall(shown + 1).map_or(NEVER, |stall| stall.start);
        let ready = stall.max(shown + 1).min(end).min(stale.max(shown) + 1) - shown;
        let words = u32::try_from(ready).map_or(left, |ready| left.min(ready));
        let last_shown = shown + u64::from(words) - 1;
        // The word after it would be fetched when it is shown.
        let is_aborted = words < left && last_shown >= stale;
        context.send(sender, shown, (held.fetched, words), is_aborted);
        (self.last_shown, self.last_taken) = (Some(last_shown), None);
        self.record_fetched(words, if words == 1 { fetched } else { last_shown - 1 });
        true
    }

    /// Records that words of the held region were fetched, the last of them at edge `last`.
    fn record_fetched(&mut self, words: u32, last: u64) {
        let (Some(held), Some(sender)) = (&mut self.held, self.queue.front()) else { return };
        held.fetched += words;
        if held.fetched == sender.words {
            self.release(last);
        }
    }

    /// Loses the held region. The word that was fetched last is the last that leaves of it.
    fn lose_held(&mut self, edge: u64, context: &mut ReadoutContext<'_>) {
        let (Some(held), Some(sender)) = (self.held, self.queue.front()) else { return };
        context.lose(edge, sender);
        if let Some(word) = &mut self.fetched {
            word.is_aborted |= held.fetched > 0;
        }
        self.release(edge + 1);
    }

    /// Removes the held region. The next can be held from edge `edge` on.
    fn release(&mut self, edge: u64) {
        self.next_hold = self.next_hold.max(edge);
        self.held = None;
        self.queue.pop_front();
    }
}

impl ReadoutContext<'_> {
    fn send(
        &mut self,
        sender: &SendingRegion,
        clock: u64,
        (first, words): (u32, u32),
        is_aborted: bool,
    ) {
        let copy = sender.copy.as_deref();
        let copied = copy.map(|copy| SentValues::copied(copy, self.word_pixels));
        let values = copied.or(self.values).expect("a region of an earlier frame has a copy");
        (self.visit)(&Transaction::Words(WordRun {
            frame: sender.frame,
            kind: sender.kind,
            regions: RegionRun::single(clock, sender.region),
            first,
            words,
            word_step: 1,
            is_last: is_aborted || first + words == sender.words,
            is_aborted,
            actions: None,
            values,
        }));
    }

    fn lose(&mut self, clock: u64, sender: &SendingRegion) {
        self.losses.push(sender.region);
        let SendingRegion { frame, region, .. } = *sender;
        (self.visit)(&Transaction::Loss(RegionLoss { clock, frame, region }));
    }
}
