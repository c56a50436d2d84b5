// SPDX-License-Identifier: MIT OR Apache-2.0
//! The rows of a table of clocks: transactions, region by region.

use crate::{DecisionRun, RegionLoss, SentKind, Transaction, WordRun};

/// The event of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClockEvent {
    /// A region is decided.
    Decision,
    /// Words of pixels leave.
    Pixels,
    /// Means leave.
    Means,
    /// A region is lost.
    Loss,
}

impl ClockEvent {
    /// Returns the name of the event in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Decision => "decision",
            Self::Pixels => "pixels",
            Self::Means => "means",
            Self::Loss => "loss",
        }
    }

    /// Returns the number of the event in arrays.
    #[must_use]
    pub fn number(self) -> u64 {
        match self {
            Self::Decision => 0,
            Self::Pixels => 1,
            Self::Means => 2,
            Self::Loss => 3,
        }
    }
}

/// A row: an event of a region, or a run of its words at evenly spaced clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockRow {
    /// The event.
    pub event: ClockEvent,
    /// The number of the frame since reset.
    pub frame: u64,
    /// The number of the region.
    pub region: u32,
    /// The clock of the event or of the first word.
    pub clock: u64,
    /// The clock of the event or of the last word.
    pub last_clock: u64,
    /// The number, in its region, of the first word.
    pub first_word: u32,
    /// The number of words, 0 for an event without words.
    pub words: u32,
    /// True if the last word is the last that leaves of its region.
    pub is_last: bool,
    /// True if no other word of the region leaves because the region was lost.
    pub is_aborted: bool,
}

impl ClockRow {
    /// The names of the columns.
    pub const COLUMNS: [&'static str; 9] = [
        "event",
        "frame",
        "region",
        "clock",
        "last_clock",
        "first_word",
        "words",
        "is_last",
        "is_aborted",
    ];

    /// Returns the numbers of the columns. The first is that of the event.
    #[must_use]
    pub fn numbers(&self) -> [u64; Self::COLUMNS.len()] {
        [
            self.event.number(),
            self.frame,
            self.region.into(),
            self.clock,
            self.last_clock,
            self.first_word.into(),
            self.words.into(),
            self.is_last.into(),
            self.is_aborted.into(),
        ]
    }

    /// Yields the rows of a transaction.
    pub(crate) fn visit_rows(transaction: &Transaction<'_>, visit: impl FnMut(&Self)) {
        match transaction {
            // Scores pass the ports before a decision; the decision has all of them.
            Transaction::Scores(_) => {}
            Transaction::Decisions(run) => Self::visit_decisions(run, visit),
            Transaction::Words(run) => Self::visit_words(run, visit),
            Transaction::Loss(loss) => Self::visit_loss(loss, visit),
            // The error belongs to no region.
            Transaction::SyncError { .. } => {}
        }
    }

    fn visit_decisions(run: &DecisionRun<'_>, mut visit: impl FnMut(&Self)) {
        for (clock, region) in run.regions.iter() {
            visit(&Self::single(ClockEvent::Decision, run.frame, region, clock));
        }
    }

    fn visit_words(run: &WordRun<'_>, mut visit: impl FnMut(&Self)) {
        let event = match run.kind {
            SentKind::Pixels => ClockEvent::Pixels,
            SentKind::Means => ClockEvent::Means,
        };
        for (clock, region) in run.senders() {
            visit(&Self {
                last_clock: run.last_clock(clock),
                first_word: run.first,
                words: run.words,
                is_last: run.is_last,
                is_aborted: run.is_aborted,
                ..Self::single(event, run.frame, region, clock)
            });
        }
    }

    fn visit_loss(loss: &RegionLoss, mut visit: impl FnMut(&Self)) {
        visit(&Self::single(ClockEvent::Loss, loss.frame, loss.region, loss.clock));
    }

    /// Makes the row of an event without words.
    fn single(event: ClockEvent, frame: u64, region: u32, clock: u64) -> Self {
        Self {
            event,
            frame,
            region,
            clock,
            last_clock: clock,
            first_word: 0,
            words: 0,
            is_last: false,
            is_aborted: false,
        }
    }
}
