// SPDX-License-Identifier: MIT OR Apache-2.0
//! The times of decisions and forwarded words of a raster core, by the rules of `docs/raster.md`.
//! They are computed per row of regions, behind a sensor and in front of a sink that is always
//! ready.
//!
//! The core takes a word as soon as the sensor has read it out, unless it still has to make words
//! of its own. So decisions come at the rate of the sensor, and the words of active regions leave
//! at the rate of the clock. Times are in *ticks*. A clock period has any number of ticks, because
//! the sensor need not be synchronous to the clock. A word that comes between two edges is taken
//! when it comes; the delay until the next edge, less than one clock, is neglected.

use crate::{RasterTiming, RegionAction};

/// The state of a raster core from frame to frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RasterStreamTiming {
    timing: RasterTiming,
    clock: u128,
    /// Time at which `ready_o` is 1 again. The next word is taken one clock later at the earliest.
    ready_time: u128,
    /// Time of the last edge of the latest second pass.
    second_pass_end: u128,
    /// Earliest time at which the readout can hold the next region, because of the region that it
    /// held last.
    next_hold_time: u128,
    /// Time at which the readout fetches the last word of the latest region.
    last_fetch_time: u128,
}

/// The times at which the output of a row of regions leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowDeparture {
    /// Time at which the last decision of the row of regions is on the ports.
    pub last_decision: u128,
    /// Time at which the last word of its regions is on the ports, or `None` if no region of the
    /// row sends pixels or means.
    pub last_word: Option<u128>,
}

/// The times of the advances of a frame.
struct AdvanceTimes<R> {
    timing: RasterTiming,
    clock: u128,
    /// Returns the times at which the sensor begins a row and at which it has read it out.
    row_times: R,
    /// For every row of the padded frame, and for every row that flushes the windows: the time of
    /// the advance before it.
    previous_advance: Vec<u128>,
}

impl<R: Fn(u32) -> (u128, u128)> AdvanceTimes<R> {
    /// Returns the time at which the word of a row comes. It waits only for the sensor and for the
    /// words before it.
    fn word_time(&self, row: u32, word: u32) -> u128 {
        let before = self.previous_advance[row as usize];
        let clocks = |words: u32| u128::from(words) * self.clock;
        if row >= self.timing.taken_rows {
            return before + clocks(word + 1);
        }
        let last = word.min(self.timing.taken_words - 1);
        let (begin, end) = (self.row_times)(row);
        let come = |word: u32| {
            let part = (end - begin) * u128::from(word + 1);
            begin + part.div_ceil(self.timing.taken_words.into())
        };
        // The core makes the words beyond the frame, one at every clock.
        come(last).max(before + clocks(last + 1)) + clocks(word - last)
    }

    /// Returns the time of advance `number`.
    fn advance_time(&self, number: u64) -> u128 {
        let row = u64::from(self.timing.row_words);
        let narrow = |value| u32::try_from(value).expect("a row and a word have 32 bits");
        self.word_time(narrow(number / row), narrow(number % row))
    }
}

impl RasterStreamTiming {
    /// Makes a core after reset whose clock period is `clock` ticks. With 0 ticks the core itself
    /// takes no time.
    #[must_use]
    pub fn new(timing: RasterTiming, clock: u128) -> Self {
        Self {
            timing,
            clock,
            ready_time: 0,
            second_pass_end: 0,
            next_hold_time: 0,
            last_fetch_time: 0,
        }
    }

    /// Computes the next frame, and returns the times of every row of regions. `read` returns the
    /// times at which the sensor begins a row and at which it has read it out. The words of a row
    /// come at equal distances in between, at most one per clock.
    ///
    /// # Panics
    /// Panics if there is not one action per region.
    pub fn advance_frame(
        &mut self,
        read: impl Fn(u32) -> (u128, u128),
        actions: &[RegionAction],
    ) -> Vec<RowDeparture> {
        let timing = self.timing;
        let columns = timing.row_words / timing.region_row_words;
        let region_rows = timing.region_words / timing.region_row_words;
        let rows = (timing.rows / region_rows) as usize;
        assert_eq!(actions.len(), rows * columns as usize, "an action per region");
        let edges = self.advance_times(read);
        let row_of_regions = u64::from(region_rows) * u64::from(timing.row_words);
        let lasts = (1..).map(|row| row * row_of_regions - u64::from(timing.row_words));
        let departures: Vec<_> = (actions.chunks_exact(columns as usize).zip(lasts))
            .map(|(actions, last_row)| {
                let mut departure = RowDeparture { last_decision: 0, last_word: None };
                for (&action, number) in actions.iter().zip(1_u64..) {
                    let last = last_row + number * u64::from(timing.region_row_words) - 1;
                    departure.last_decision =
                        self.decision_time(edges.advance_time(last + timing.tail_delay()));
                    if let Some(words) = timing.words_sent(action) {
                        departure.last_word =
                            Some(self.departure_time(departure.last_decision, words));
                    }
                }
                departure
            })
            .collect();
        let taken = edges.word_time(timing.taken_rows - 1, timing.taken_words - 1);
        self.ready_time = taken + self.ticks(timing.edges_to_ready());
        if timing.waits_for_pending {
            for departure in &departures {
                let done = departure.last_word.map_or(0, |left| left + self.clock);
                self.ready_time = self.ready_time.max(departure.last_decision).max(done);
            }
        }
        departures
    }

    fn advance_times<R: Fn(u32) -> (u128, u128)>(&self, read: R) -> AdvanceTimes<R> {
        let Self { timing, clock, ready_time: ready, .. } = *self;
        let mut edges =
            AdvanceTimes { timing, clock, row_times: read, previous_advance: vec![ready] };
        for row in 0..timing.rows + timing.windows {
            edges.previous_advance.push(edges.word_time(row, timing.row_words - 1));
        }
        edges
    }

    /// Returns the time of the decision of a region whose last word reaches the tail at `edge`.
    fn decision_time(&mut self, edge: u128) -> u128 {
        let timing = self.timing;
        let Some(pass) = timing.second_pass else {
            return edge + self.ticks(timing.decision_latency.into());
        };
        let stored = edge + self.ticks(timing.store_latency.into());
        let first = stored + self.ticks(pass.after_store.into());
        let first = first.max(self.second_pass_end + self.clock);
        self.second_pass_end = first + self.ticks(u64::from(timing.region_words) - 1);
        self.second_pass_end + self.ticks(pass.decision_latency.into())
    }

    /// Returns the time at which the last of `words` words of a region leaves. The readout starts
    /// to hold the region at the edge at which it fetches the last word of the region before, or
    /// later. It fetches the words of the region at the edges after that. A word is on the ports
    /// one clock after it was fetched.
    fn departure_time(&mut self, decided: u128, words: u32) -> u128 {
        let entered = decided + self.clock;
        let oldest = entered + self.ticks(self.timing.queue_latency.into());
        let held = self.last_fetch_time.max(self.next_hold_time).max(oldest);
        self.next_hold_time = held + self.ticks(self.timing.hold_interval.into());
        self.last_fetch_time = held + self.ticks(words.into());
        self.last_fetch_time + self.clock
    }

    fn ticks(&self, clocks: u64) -> u128 {
        u128::from(clocks) * self.clock
    }
}
