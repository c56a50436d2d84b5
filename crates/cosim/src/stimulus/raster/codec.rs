// SPDX-License-Identifier: MIT OR Apache-2.0
//! What goes into the model of a core, and what comes out, in records.

use super::super::applied::Applied;
use super::super::kinds::Kinds;
use crate::layout::Layout;
use foveate_design::{PortRole, RasterDesign};
use foveate_model::RasterOutput;

/// Puts values of raster models into records.
#[derive(Clone, Debug)]
pub struct RasterCodec {
    kinds: Kinds,
}

impl RasterCodec {
    /// The codec of a design.
    #[must_use]
    pub fn new(design: RasterDesign<'_>) -> Self {
        Self { kinds: Kinds::of(&design) }
    }

    pub(crate) fn inputs(&self, layout: &Layout, applied: &Applied<'_>, record: &mut [u8]) {
        applied.write(&self.kinds, layout, record);
    }

    /// The outputs of the core after an edge.
    pub fn outputs(&self, layout: &Layout, output: &RasterOutput, record: &mut [u8]) {
        for field in layout.fields() {
            let value = match field.port.role {
                PortRole::Ready => output.ready.into(),
                PortRole::SyncError => output.sync_error.into(),
                PortRole::ReferenceReady => output.reference_ready.into(),
                PortRole::StoreValid => output.store_valid.into(),
                PortRole::StorePixel => {
                    field.set_words(record, &output.store_pixels);
                    continue;
                }
                PortRole::StoreLast => output.store_last.into(),
                PortRole::Underrun => output.underrun.into(),
                PortRole::DecisionValid => output.decision_valid.into(),
                PortRole::Region => output.region.into(),
                PortRole::Srs => output.srs.into(),
                PortRole::Trs => output.trs.into(),
                PortRole::Active => output.active.into(),
                PortRole::Score(kind) => output.scores[self.kinds.index(kind)],
                PortRole::TemporalCount => output.temporal_count.into(),
                PortRole::ForwardValid => output.forward_valid.into(),
                PortRole::ForwardRegion => output.forward_region.into(),
                PortRole::ForwardPosition => output.forward_position.into(),
                PortRole::ForwardPixel => {
                    field.set_words(record, &output.forward_pixels);
                    continue;
                }
                PortRole::ForwardFirst => output.forward_first.into(),
                PortRole::ForwardLast => output.forward_last.into(),
                PortRole::ForwardAbort => output.forward_abort.into(),
                PortRole::ForwardFrame => output.forward_frame.into(),
                PortRole::Lost => output.lost.into(),
                PortRole::LostCount => output.lost_count.into(),
                PortRole::LostValid => output.lost_valid.into(),
                PortRole::LostRegion => output.lost_region.into(),
                PortRole::LostFrame => output.lost_frame.into(),
                // Inputs, and what a core does not have.
                _ => continue,
            };
            field.set(record, 0, value);
        }
    }
}
