// SPDX-License-Identifier: MIT OR Apache-2.0
//! The temporal score against both possible references.
//!
//! ```text
//!                       frame t-1 active?   reference of frame t
//! previous              -                   x(t-1)
//! last-sent             yes                 x(t-1), now the last one sent
//! last-sent             no                  what was sent before it, if still valid
//! ```
//!
//! Without `mad` the answer is known at the first tail step of frame t. With `mad` it is known when
//! frame t is done, so both counts run.

use foveate_design::{Irrelevant, Reference};

use super::decide::Decision;
use super::plan::RpuPlan;
use super::store::Store;

/// Counters and validity of the references.
#[derive(Clone, Debug, Default)]
pub(super) struct TemporalScore {
    /// Pixels that differ from the previous frame.
    against_previous: u32,
    /// Pixels that differ from what was last sent, as far as it is decided.
    against_sent: u32,
    /// A frame has come in since reset.
    pub(super) has_previous: bool,
    /// What was last sent may serve as a reference.
    sent_valid: bool,
}

impl TemporalScore {
    /// A tail step.
    pub(super) fn step(&mut self, store: &Store, position: usize, pixel: u16, level: u32) {
        let differs = |reference: u16| u32::from(pixel.abs_diff(reference)) > level;
        let from_previous = !self.has_previous || differs(store.previous(position));
        let from_sent = !self.sent_valid || differs(store.sent(position));
        self.against_previous += u32::from(from_previous);
        self.against_sent += u32::from(from_sent);
    }

    /// The count as it runs, where no later decision can change it.
    pub(super) fn running(&self, plan: &RpuPlan) -> u32 {
        match plan.reference {
            Reference::Previous => self.against_previous,
            Reference::LastSent => self.against_sent,
        }
    }

    /// With a second pass: the count of the frame that is done, now that the frame before it is
    /// decided (or there was none).
    pub(super) fn settled(&self, plan: &RpuPlan, decision: Option<Decision>, n: u32) -> u32 {
        match (plan.reference, decision) {
            (Reference::Previous, _) => self.against_previous,
            (Reference::LastSent, Some(decision)) if decision.active() => self.against_previous,
            (Reference::LastSent, Some(decision)) if blanks(plan, decision) => n,
            (Reference::LastSent, _) => self.against_sent,
        }
    }

    /// The edge after done: counters start anew, references follow the decision.
    pub(super) fn finish(&mut self, plan: &RpuPlan, decision: Option<Decision>) {
        self.against_previous = 0;
        self.against_sent = 0;
        self.has_previous = true;
        match decision {
            Some(decision) if decision.active() => self.sent_valid = true,
            Some(decision) if blanks(plan, decision) => self.sent_valid = false,
            Some(_) | None => {}
        }
    }
}

/// Whether the region becomes black or shows its means, so that what was sent is no longer on the screen.
fn blanks(plan: &RpuPlan, decision: Decision) -> bool {
    match plan.irrelevant {
        Irrelevant::Zero | Irrelevant::Mean => !decision.srs,
        Irrelevant::Hold => false,
    }
}
