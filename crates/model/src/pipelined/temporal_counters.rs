// SPDX-License-Identifier: MIT OR Apache-2.0
//! The temporal score, counted against both possible references.
//!
//! ```text
//!                       frame t-1 active?   reference of frame t
//! previous              -                   x(t-1)
//! last-sent             yes                 x(t-1), now the last one sent
//! last-sent             no                  what was sent before it, if still valid
//! ```
//!
//! Without a second pass the reference is known at the first tail step of frame t. With a second
//! pass it is known when frame t is done, so both counts run.

use foveate_camera::{IrrelevantRendering, ReferencePolicy};

use super::frame_store::RegionFrameStore;
use super::relevance::RelevanceBits;
use super::rpu_parameters::RpuParameters;

/// The counters, and the validity of the references.
#[derive(Clone, Debug, Default)]
pub(super) struct TemporalCounters {
    /// Number of pixels that differ from the previous frame.
    against_previous: u32,
    /// Number of pixels that differ from the last frame that was sent, as far as decisions are
    /// known.
    against_sent: u32,
    /// True if a complete frame has come since reset.
    pub(super) has_previous: bool,
    /// True if the frame that was sent last is a valid reference.
    sent_valid: bool,
}

impl TemporalCounters {
    /// Applies a tail step.
    pub(super) fn step(
        &mut self,
        store: &RegionFrameStore,
        position: usize,
        pixel: u16,
        level: u32,
    ) {
        let differs = |reference: u16| u32::from(pixel.abs_diff(reference)) > level;
        let from_previous = !self.has_previous || differs(store.previous(position));
        let from_sent = !self.sent_valid || differs(store.sent(position));
        self.against_previous += u32::from(from_previous);
        self.against_sent += u32::from(from_sent);
    }

    /// Returns the running count against the reference. It is valid if no later decision can change
    /// the reference.
    pub(super) fn running_count(&self, plan: &RpuParameters) -> u32 {
        match plan.reference {
            ReferencePolicy::Previous => self.against_previous,
            ReferencePolicy::LastSent => self.against_sent,
        }
    }

    /// Returns the count of the frame that is done, for a design with a second pass. The frame
    /// before it is decided now, or does not exist.
    pub(super) fn final_count(&self, plan: &RpuParameters, decision: Option<RelevanceBits>) -> u32 {
        match (plan.reference, decision) {
            (ReferencePolicy::Previous, _) => self.against_previous,
            (ReferencePolicy::LastSent, Some(decision)) if decision.is_active() => {
                self.against_previous
            }
            (ReferencePolicy::LastSent, Some(decision))
                if invalidates_reference(plan, decision) =>
            {
                plan.pixel_count()
            }
            (ReferencePolicy::LastSent, _) => self.against_sent,
        }
    }

    /// Applies the edge after done: counters are cleared, and the references follow the decision.
    pub(super) fn finish(&mut self, plan: &RpuParameters, decision: Option<RelevanceBits>) {
        self.against_previous = 0;
        self.against_sent = 0;
        self.has_previous = true;
        match decision {
            Some(decision) if decision.is_active() => self.sent_valid = true,
            Some(decision) if invalidates_reference(plan, decision) => self.sent_valid = false,
            Some(_) | None => {}
        }
    }
}

/// Returns true if the region becomes black or shows its means, so that the screen no longer shows
/// the pixels that were sent.
fn invalidates_reference(plan: &RpuParameters, decision: RelevanceBits) -> bool {
    match plan.irrelevant {
        IrrelevantRendering::Zero | IrrelevantRendering::Mean => !decision.srs,
        IrrelevantRendering::Hold => false,
    }
}
