// SPDX-License-Identifier: MIT OR Apache-2.0
//! What goes into the model of an array, and what comes out, in records.

use super::super::applied::Applied;
use super::super::kinds::Kinds;
use crate::layout::Layout;
use foveate_design::{PortRole, SerialDesign};
use foveate_model::SerialOutput;

/// Puts values of serial models into records.
#[derive(Clone, Debug)]
pub struct SerialCodec {
    kinds: Kinds,
}

impl SerialCodec {
    /// The codec of a design.
    #[must_use]
    pub fn new(design: SerialDesign<'_>) -> Self {
        Self { kinds: Kinds::of(&design) }
    }

    pub(crate) fn inputs(&self, layout: &Layout, applied: &Applied<'_>, record: &mut [u8]) {
        applied.write(&self.kinds, layout, record);
    }

    /// The outputs of the array after an edge.
    pub fn outputs(&self, layout: &Layout, output: &SerialOutput, record: &mut [u8]) {
        for field in layout.fields() {
            let value = match field.port.role {
                PortRole::Ready => output.ready.into(),
                PortRole::SyncError => output.sync_error.into(),
                PortRole::ScoreValid => output.score_valid.into(),
                PortRole::ScoreIndex => output.score_index.into(),
                PortRole::Region => output.region.into(),
                PortRole::AnyScore => output.score,
                PortRole::DecisionValid => output.decision_valid.into(),
                PortRole::Srs => output.srs.into(),
                PortRole::Trs => output.trs.into(),
                PortRole::Active => output.active.into(),
                PortRole::ForwardPosition => output.forward_position.into(),
                PortRole::ForwardSlot => output.forward_slot.into(),
                PortRole::ForwardRegion => output.forward_region.into(),
                PortRole::ForwardValid => {
                    field.set_all(record, output.forward_valid.iter().map(|&valid| valid.into()));
                    continue;
                }
                PortRole::ForwardPixel => {
                    field.set_all(record, output.forward_pixel.iter().map(|&pixel| pixel.into()));
                    continue;
                }
                // Inputs, and what only pipelined designs have.
                _ => continue,
            };
            field.set(record, 0, value);
        }
    }
}
