// SPDX-License-Identifier: MIT OR Apache-2.0
//! The latency of every frame of a run, and the regions that wait.

use std::collections::{BTreeMap, VecDeque};

use foveate_design::Design;

use crate::{DecisionRun, RegionLoss, SentKind, Transaction, WordRun};

/// The latency of a frame, and the regions that wait while it is the newest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameTraffic {
    /// The number of the frame in the run.
    pub frame: u64,
    /// The edge from which its latencies count.
    pub since: u64,
    /// The clock of its last decision, or `None` if it was not decided.
    pub last_decision: Option<u64>,
    /// The clock of its last word, or `None` if none left.
    pub last_word: Option<u64>,
    /// The number of its regions that were lost.
    pub lost_regions: u64,
    /// The largest number of regions, of this frame and of those before, that wait at a clock
    /// before the next frame. A region waits from its decision until its last word is on the ports,
    /// or until it is lost.
    pub waiting_regions: u64,
}

/// A collector of [`FrameTraffic`] from the transactions of a run without resets. It keeps three
/// frames at most.
#[derive(Debug)]
pub struct TrafficMeter {
    has_forwarding: bool,
    /// The frames whose transactions may still come, the oldest first.
    frames: VecDeque<FrameTraffic>,
    frame: u64,
    /// The number of regions that wait.
    waiting: i64,
    /// The changes of this number by their clocks, which the newest frame may still add to.
    changes: BTreeMap<u64, i64>,
}

impl TrafficMeter {
    /// The number of frames that a frame may follow before its last word leaves.
    const FRAMES_TO_LAST_WORD: usize = 2;

    /// Makes a meter for a run of a design.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        Self {
            has_forwarding: design.has_forwarding(),
            frames: VecDeque::new(),
            frame: 0,
            waiting: 0,
            changes: BTreeMap::new(),
        }
    }

    /// Begins a frame whose latencies count from edge `since`, which is not before that of the
    /// frame before. The model must not have the frame yet.
    pub fn begin_frame(&mut self, since: u64) {
        self.frames.push_back(FrameTraffic {
            frame: self.frame,
            since,
            last_decision: None,
            last_word: None,
            lost_regions: 0,
            waiting_regions: 0,
        });
        self.frame += 1;
    }

    /// Adds a transaction of the model.
    pub fn add(&mut self, transaction: &Transaction<'_>) {
        match transaction {
            Transaction::Decisions(run) => self.add_decisions(run),
            Transaction::Words(run) => self.add_words(run),
            Transaction::Loss(loss) => self.add_loss(loss),
            Transaction::Scores(_) | Transaction::SyncError { .. } => {}
        }
    }

    /// Ends the frame that was begun last, when the model has taken it. Returns the oldest frame,
    /// if no transaction of it can follow.
    pub fn end_frame(&mut self) -> Option<FrameTraffic> {
        let since = self.frames.back()?.since;
        if let Some(before) = self.frames.len().checked_sub(2) {
            let later = self.changes.split_off(&since);
            let changes = std::mem::replace(&mut self.changes, later);
            self.measure_waiting(before, changes);
        }
        let is_complete = self.frames.len() > Self::FRAMES_TO_LAST_WORD;
        is_complete.then(|| self.frames.pop_front()).flatten()
    }

    /// Returns the frames that are left, when the run is over.
    pub fn finish(mut self) -> impl Iterator<Item = FrameTraffic> {
        if let Some(last) = self.frames.len().checked_sub(1) {
            let changes = std::mem::take(&mut self.changes);
            self.measure_waiting(last, changes);
        }
        self.frames.into_iter()
    }

    /// Applies changes while the frame at a place is the newest.
    fn measure_waiting(&mut self, place: usize, changes: BTreeMap<u64, i64>) {
        let mut most = self.waiting;
        for change in changes.into_values() {
            self.waiting += change;
            most = most.max(self.waiting);
        }
        self.frames[place].waiting_regions = u64::try_from(most).unwrap_or(0);
    }

    fn add_decisions(&mut self, run: &DecisionRun<'_>) {
        for (clock, region) in run.regions.iter() {
            if let Some(frame) = self.frame_mut(run.frame) {
                frame.last_decision = frame.last_decision.max(Some(clock));
            }
            let action = run.outcome.actions[region as usize];
            if self.has_forwarding && SentKind::from_action(action).is_some() {
                *self.changes.entry(clock).or_default() += 1;
            }
        }
    }

    fn add_words(&mut self, run: &WordRun<'_>) {
        for (clock, _) in run.senders() {
            let last = run.last_clock(clock);
            if let Some(frame) = self.frame_mut(run.frame) {
                frame.last_word = frame.last_word.max(Some(last));
            }
            // A region that is lost in the middle stops to wait at its loss.
            if run.is_last && !run.is_aborted {
                *self.changes.entry(last).or_default() -= 1;
            }
        }
    }

    fn add_loss(&mut self, loss: &RegionLoss) {
        if let Some(frame) = self.frame_mut(loss.frame) {
            frame.lost_regions += 1;
        }
        *self.changes.entry(loss.clock).or_default() -= 1;
    }

    /// Returns a frame that is not complete.
    fn frame_mut(&mut self, frame: u64) -> Option<&mut FrameTraffic> {
        let place = frame.checked_sub(self.frames.front()?.frame)?;
        self.frames.get_mut(usize::try_from(place).ok()?)
    }
}
