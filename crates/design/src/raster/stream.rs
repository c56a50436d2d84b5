// SPDX-License-Identifier: MIT OR Apache-2.0
//! When a raster core says what, behind a sensor and in front of a sink that is always ready: the rules of
//! `docs/raster.md`, row of regions by row of regions.
//!
//! The core takes a word as soon as the sensor has read it, unless it still has words of its own to make. So
//! decisions fall at the sensor's rate, and the words of active regions leave at that of the clock. Times are in
//! *ticks*, of which a clock has any number: a sensor need not know the clock. A word that comes between two edges
//! is taken when it comes; up to a clock more, until the next edge, is left out.

use crate::{Action, RasterTiming};

/// A raster core, frame after frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RasterStream {
    timing: RasterTiming,
    clock: u128,
    /// When `ready_o` is 1 again: the next word is taken a clock later at the earliest.
    ready: u128,
    /// The last edge of the second pass before.
    passed: u128,
    /// When the readout can hold the next region, having held one not long ago.
    rested: u128,
    /// When the readout has fetched the last word of the region before.
    fetched: u128,
}

/// What of a frame leaves when.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowDeparture {
    /// When the last decision of a row of regions is on the ports.
    pub decided: u128,
    /// When the last word of its regions is; none where none of them sends pixels or means.
    pub left: Option<u128>,
}

/// The edges of the advances of a frame.
struct Edges<R> {
    timing: RasterTiming,
    clock: u128,
    /// When the sensor begins a row, and when it has read it.
    read: R,
    /// Of every row of the padded frame and of those that flush the windows: the edge of the advance before.
    before: Vec<u128>,
}

impl<R: Fn(u32) -> (u128, u128)> Edges<R> {
    /// When a word of a row comes, if nothing but the sensor and the words before it is waited for.
    fn edge(&self, row: u32, word: u32) -> u128 {
        let before = self.before[row as usize];
        let clocks = |words: u32| u128::from(words) * self.clock;
        if row >= self.timing.taken_rows {
            return before + clocks(word + 1);
        }
        let last = word.min(self.timing.taken_words - 1);
        let (begin, end) = (self.read)(row);
        let come = |word: u32| {
            let part = (end - begin) * u128::from(word + 1);
            begin + part.div_ceil(self.timing.taken_words.into())
        };
        // What lies beyond the frame the core makes at every clock.
        come(last).max(before + clocks(last + 1)) + clocks(word - last)
    }

    /// When word `number` of the advances comes.
    fn of(&self, number: u64) -> u128 {
        let row = u64::from(self.timing.row_words);
        let narrow = |value| u32::try_from(value).expect("a row and a word have 32 bits");
        self.edge(narrow(number / row), narrow(number % row))
    }
}

impl RasterStream {
    /// A core after reset, with a clock of so many ticks: none for a core that takes no time.
    #[must_use]
    pub fn new(timing: RasterTiming, clock: u128) -> Self {
        Self { timing, clock, ready: 0, passed: 0, rested: 0, fetched: 0 }
    }

    /// The next frame. `read` says of every row when the sensor begins it and when it has read it; the words of a
    /// row come evenly in between, at most one at every clock. Answers for every row of regions.
    ///
    /// # Panics
    /// When there is not one action per region.
    pub fn frame(
        &mut self,
        read: impl Fn(u32) -> (u128, u128),
        actions: &[Action],
    ) -> Vec<RowDeparture> {
        let timing = self.timing;
        let columns = timing.row_words / timing.region_row_words;
        let region_rows = timing.region_words / timing.region_row_words;
        let rows = (timing.rows / region_rows) as usize;
        assert_eq!(actions.len(), rows * columns as usize, "an action per region");
        let edges = self.edges(read);
        let row_of_regions = u64::from(region_rows) * u64::from(timing.row_words);
        let lasts = (1..).map(|row| row * row_of_regions - u64::from(timing.row_words));
        let departures: Vec<_> = (actions.chunks_exact(columns as usize).zip(lasts))
            .map(|(actions, last_row)| {
                let mut departure = RowDeparture { decided: 0, left: None };
                for (&action, number) in actions.iter().zip(1_u64..) {
                    let last = last_row + number * u64::from(timing.region_row_words) - 1;
                    departure.decided = self.decide(edges.of(last + timing.tail_delay()));
                    if let Some(words) = timing.words_sent(action) {
                        departure.left = Some(self.leave(departure.decided, words));
                    }
                }
                departure
            })
            .collect();
        let taken = edges.edge(timing.taken_rows - 1, timing.taken_words - 1);
        self.ready = taken + self.clocks(timing.edges_to_ready());
        if timing.waits_for_pending {
            for departure in &departures {
                let done = departure.left.map_or(0, |left| left + self.clock);
                self.ready = self.ready.max(departure.decided).max(done);
            }
        }
        departures
    }

    fn edges<R: Fn(u32) -> (u128, u128)>(&self, read: R) -> Edges<R> {
        let Self { timing, clock, ready, .. } = *self;
        let mut edges = Edges { timing, clock, read, before: vec![ready] };
        for row in 0..timing.rows + timing.windows {
            edges.before.push(edges.edge(row, timing.row_words - 1));
        }
        edges
    }

    /// When a region is decided whose last word comes to the tail at `edge`.
    fn decide(&mut self, edge: u128) -> u128 {
        let timing = self.timing;
        let Some(pass) = timing.second_pass else {
            return edge + self.clocks(timing.decision_latency.into());
        };
        let stored = edge + self.clocks(timing.store_latency.into());
        let first = stored + self.clocks(pass.after_store.into());
        let first = first.max(self.passed + self.clock);
        self.passed = first + self.clocks(u64::from(timing.region_words) - 1);
        self.passed + self.clocks(pass.decision_latency.into())
    }

    /// When the last of so many words of a region leaves. It is held from the edge on at which the last word of the
    /// region before is fetched, or later; its own are fetched at the edges after that. A word is on the ports a
    /// clock after it was fetched.
    fn leave(&mut self, decided: u128, words: u32) -> u128 {
        let entered = decided + self.clock;
        let oldest = entered + self.clocks(self.timing.queue_latency.into());
        let held = self.fetched.max(self.rested).max(oldest);
        self.rested = held + self.clocks(2);
        self.fetched = held + self.clocks(words.into());
        self.fetched + self.clock
    }

    fn clocks(&self, clocks: u64) -> u128 {
        u128::from(clocks) * self.clock
    }
}
