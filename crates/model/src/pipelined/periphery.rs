// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summaries of a region: its means frame by frame, which of them were sent, and when they leave.

use foveate_design::Action;

use super::decide::Decision;
use super::plan::RpuPlan;
use crate::number::index;
use crate::periphery::{Summary, block_means, last_of_block};

/// Means and what is known of them.
#[derive(Clone, Debug, Default)]
pub(super) struct TailSummary {
    /// The payload of the frame that comes in, as far as it has.
    current: Vec<u16>,
    /// The means of the last frame that is whole.
    previous: Vec<u16>,
    /// What the receiver shows.
    summary: Summary,
    /// The means that leave while this frame comes in.
    sent: Option<Vec<u16>>,
}

impl TailSummary {
    /// A tail step. Without a periphery nobody asks for means.
    pub(super) fn step(&mut self, plan: &RpuPlan, payload: u16) {
        if plan.periphery.is_some() {
            self.current.push(payload);
        }
    }

    /// What becomes of the region whose decision is made in this clock.
    pub(super) fn action(&self, plan: &RpuPlan, decision: Decision, level: u32) -> Action {
        let Decision { srs, trs } = decision;
        self.summary.action(plan.irrelevant, srs, trs, &self.decided(plan), level)
    }

    /// The means of the frame that is decided in this clock, in which the frame that has come in is whole.
    fn decided(&self, plan: &RpuPlan) -> Vec<u16> {
        if plan.second_pass { self.previous.clone() } else { self.means(plan) }
    }

    fn means(&self, plan: &RpuPlan) -> Vec<u16> {
        let pixels = self.current.iter().copied();
        plan.periphery.map_or(Vec::new(), |periphery| block_means(&periphery, pixels))
    }

    /// The edge after done.
    pub(super) fn finish(&mut self, plan: &RpuPlan, decision: Option<Decision>, level: u32) {
        self.sent = None;
        if let Some(decision) = decision {
            let (Decision { srs, trs }, means) = (decision, self.decided(plan));
            let action = self.summary.decide(plan.irrelevant, srs, trs, &means, level);
            self.sent = (action == Action::Summarize).then_some(means);
        }
        self.previous = self.means(plan);
        self.current.clear();
    }

    /// The mean that leaves at a tail step: that of the block whose last pixel steps.
    pub(super) fn leaving(&self, plan: &RpuPlan, position: usize) -> Option<u16> {
        let (sent, periphery) = (self.sent.as_ref()?, plan.periphery?);
        let mut blocks = (0..).zip(sent);
        let is_whole = |&(block, _): &(u32, _)| index(last_of_block(&periphery, block)) == position;
        blocks.find(is_whole).map(|(_, &mean)| mean)
    }
}
