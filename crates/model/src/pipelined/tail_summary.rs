// SPDX-License-Identifier: MIT OR Apache-2.0
//! The summaries of a region: the means of the last frames, the means that were sent, and the means
//! that leave.

use foveate_camera::RegionAction;

use super::relevance::RelevanceBits;
use super::rpu_parameters::RpuParameters;
use crate::conversions::index;
use crate::periphery::{ShownSummary, block_means, last_position_of_block};

/// The means of a region and the state of its summary.
#[derive(Clone, Debug, Default)]
pub(super) struct TailSummary {
    /// The payload of the current frame, as far as it has come.
    current: Vec<u16>,
    /// The means of the last complete frame.
    previous: Vec<u16>,
    /// The summary that the screen shows.
    summary: ShownSummary,
    /// The means that leave while the current frame comes in.
    sent: Option<Vec<u16>>,
}

impl TailSummary {
    /// Applies a tail step. Without a periphery the payload is not needed.
    pub(super) fn step(&mut self, plan: &RpuParameters, payload: u16) {
        if plan.periphery.is_some() {
            self.current.push(payload);
        }
    }

    /// Returns the action on the region whose decision is made in this clock.
    pub(super) fn action(
        &self,
        plan: &RpuParameters,
        decision: RelevanceBits,
        level: u32,
    ) -> RegionAction {
        let RelevanceBits { srs, trs } = decision;
        self.summary.action(plan.irrelevant, srs, trs, &self.decided_means(plan), level)
    }

    /// Returns the means of the frame that is decided in this clock, in which the current frame is
    /// complete.
    fn decided_means(&self, plan: &RpuParameters) -> Vec<u16> {
        if plan.second_pass { self.previous.clone() } else { self.means(plan) }
    }

    fn means(&self, plan: &RpuParameters) -> Vec<u16> {
        let pixels = self.current.iter().copied();
        plan.periphery.map_or(Vec::new(), |periphery| block_means(&periphery, pixels))
    }

    /// Applies the edge after done.
    pub(super) fn finish(
        &mut self,
        plan: &RpuParameters,
        decision: Option<RelevanceBits>,
        level: u32,
    ) {
        self.sent = None;
        if let Some(decision) = decision {
            let (RelevanceBits { srs, trs }, means) = (decision, self.decided_means(plan));
            let action = self.summary.decide(plan.irrelevant, srs, trs, &means, level);
            self.sent = (action == RegionAction::Summarize).then_some(means);
        }
        self.previous = self.means(plan);
        self.current.clear();
    }

    /// Returns the mean that leaves at a tail step: that of the block whose last pixel has this
    /// position.
    pub(super) fn leaving_mean(&self, plan: &RpuParameters, position: usize) -> Option<u16> {
        let (sent, periphery) = (self.sent.as_ref()?, plan.periphery?);
        let mut blocks = (0..).zip(sent);
        let is_whole =
            |&(block, _): &(u32, _)| index(last_position_of_block(&periphery, block)) == position;
        blocks.find(is_whole).map(|(_, &mean)| mean)
    }
}
