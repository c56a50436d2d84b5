// SPDX-License-Identifier: MIT OR Apache-2.0
//! The temporal score against the references that may count; which they are is in the model.

use foveate_design::{Irrelevant, Reference};
use foveate_lanes::{Lane, threshold};

use crate::counts::{add_all, add_changes};
use crate::plan::Plan;
use crate::rows::{Row, row};
use crate::store::Store;
use crate::wide::{Count, Types};
use crate::window::Pixels;

/// The decisions of a clock that concern references, a row of lanes each: 1 or 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decided<'a> {
    pub(crate) srs: &'a Row<u8>,
    pub(crate) active: &'a Row<u8>,
}

/// Counters and validity of the references.
#[derive(Clone, Debug)]
pub(crate) struct TemporalScore<Y: Types> {
    against_previous: Option<Row<Y::Count>>,
    against_sent: Option<Row<Y::Count>>,
    /// A frame has come in since reset.
    pub(crate) has_previous: bool,
    /// 1 where nothing that was sent may serve as a reference.
    sent_invalid: Row<Y::Pixel>,
    /// With a second pass: the counts of the frame before.
    held: Option<Row<Y::Count>>,
}

impl<Y: Types> TemporalScore<Y> {
    pub(crate) fn new(plan: &Plan) -> Self {
        let last_sent = keeps_sent(plan);
        let mut sent_invalid = row(plan.lanes);
        sent_invalid.fill(Y::Pixel::ONE);
        Self {
            against_previous: (!last_sent || plan.second_pass).then(|| row(plan.lanes)),
            against_sent: last_sent.then(|| row(plan.lanes)),
            has_previous: false,
            sent_invalid,
            held: plan.second_pass.then(|| row(plan.lanes)),
        }
    }

    pub(crate) fn reset(&mut self) {
        self.has_previous = false;
        self.sent_invalid.fill(Y::Pixel::ONE);
        let rows = [&mut self.against_previous, &mut self.against_sent, &mut self.held];
        rows.into_iter().flatten().for_each(|row| row.fill(Y::Count::default()));
    }

    /// A tail step.
    #[inline(always)]
    pub(crate) fn step(
        &mut self,
        store: &Store<Y::Pixel>,
        position: usize,
        now: Pixels<'_, Y::Pixel>,
        level: u32,
    ) {
        let level = threshold(level);
        if let Some(counts) = &mut self.against_previous {
            if self.has_previous {
                add_changes::<Y>(counts, now.scored, store.previous(position), level, None);
            } else {
                add_all::<Y>(counts);
            }
        }
        if let (Some(counts), Some(sent)) = (&mut self.against_sent, store.sent(position)) {
            add_changes::<Y>(counts, now.scored, sent, level, Some(&self.sent_invalid));
        }
    }

    /// What the count ports show.
    pub(crate) fn shown(&self) -> &[Y::Count] {
        let running = self.against_sent.as_ref().or(self.against_previous.as_ref());
        self.held.as_ref().or(running).map_or(&[], |row| row)
    }

    /// The edge after done: counts are held, counters start anew, references follow the decision, if
    /// there was one.
    pub(crate) fn finish(&mut self, plan: &Plan, decided: Option<Decided<'_>>) {
        self.hold(plan, decided);
        let counters = [&mut self.against_previous, &mut self.against_sent];
        counters.into_iter().flatten().for_each(|row| row.fill(Y::Count::default()));
        self.has_previous = true;
        let Some(decided) = decided else { return };
        let lanes = self.sent_invalid.iter_mut().zip(decided.srs.iter()).zip(decided.active.iter());
        for ((invalid, &srs), &active) in lanes {
            if active != 0 {
                *invalid = Y::Pixel::default();
            } else if blanks(plan, srs) {
                *invalid = Y::Pixel::ONE;
            }
        }
    }

    /// The counts of the frame that is done, now that the frame before it is decided.
    fn hold(&mut self, plan: &Plan, decided: Option<Decided<'_>>) {
        let (Some(held), Some(previous)) = (&mut self.held, &self.against_previous) else { return };
        held.copy_from_slice(previous);
        let (Some(sent), Some(decided)) = (&self.against_sent, decided) else {
            if let Some(sent) = &self.against_sent {
                held.copy_from_slice(sent);
            }
            return;
        };
        let all =
            Y::Count::minimum(plan.pixels as u64).expect("a count holds all pixels of a region");
        for (lane, held) in held.iter_mut().enumerate() {
            if decided.active[lane] != 0 {
                continue;
            }
            *held = if blanks(plan, decided.srs[lane]) { all } else { sent[lane] };
        }
    }
}

/// Whether what was last sent is the reference.
pub(crate) fn keeps_sent(plan: &Plan) -> bool {
    match plan.reference {
        Reference::Previous => false,
        Reference::LastSent => true,
    }
}

/// Whether the region becomes black, so that what was sent is no longer on the screen.
fn blanks(plan: &Plan, srs: u8) -> bool {
    match plan.irrelevant {
        Irrelevant::Zero => srs == 0,
        Irrelevant::Hold => false,
    }
}
