// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model behind one interface, and its values in records.

use super::super::applied::Applied;
use super::super::kinds::Kinds;
use crate::layout::Layout;
use foveate_design::{PipelinedDesign, PortRole};
use foveate_model::{PipelinedRcm, PipelinedRpu, RpuInput, RpuOutput};

/// A model of one RPU or of an array of them.
#[derive(Clone, Debug)]
pub(crate) enum Machine {
    Rpu(Box<PipelinedRpu>),
    Rcm(PipelinedRcm),
}

impl Machine {
    /// One edge; says what `sync_error_o` shows after it, where that is a port.
    pub(crate) fn step(&mut self, inputs: &Applied<'_>, outputs: &mut Vec<RpuOutput>) -> bool {
        outputs.clear();
        match self {
            Self::Rpu(rpu) => {
                let input = RpuInput {
                    reset: inputs.reset,
                    valid: inputs.valid,
                    pixel: inputs.pixels[0],
                    border: inputs.border,
                };
                outputs.push(rpu.step(&input, &inputs.thresholds));
                false
            }
            Self::Rcm(rcm) => {
                outputs.extend_from_slice(rcm.step(&inputs.of_rpus()));
                rcm.sync_error()
            }
        }
    }
}

/// Puts values of pipelined models into records.
#[derive(Clone, Debug)]
pub struct PipelinedCodec {
    kinds: Kinds,
}

impl PipelinedCodec {
    /// The codec of a design.
    #[must_use]
    pub fn new(design: PipelinedDesign<'_>) -> Self {
        Self { kinds: Kinds::of(&design) }
    }

    pub(crate) fn inputs(&self, layout: &Layout, applied: &Applied<'_>, record: &mut [u8]) {
        applied.write(&self.kinds, layout, record);
    }

    /// The outputs of all RPUs after an edge, and what `sync_error_o` shows, where that is a port.
    pub fn outputs(
        &self,
        layout: &Layout,
        outputs: &[RpuOutput],
        sync_error: bool,
        record: &mut [u8],
    ) {
        for field in layout.fields() {
            for (lane, output) in (0..field.port.lanes).zip(outputs) {
                let value = match field.port.role {
                    PortRole::SyncError => sync_error.into(),
                    PortRole::DecisionValid => output.decision_valid.into(),
                    PortRole::Srs => output.srs.into(),
                    PortRole::Trs => output.trs.into(),
                    PortRole::Active => output.active.into(),
                    PortRole::Score(kind) => output.scores[self.kinds.index(kind)],
                    PortRole::TemporalCount => output.temporal_count.into(),
                    PortRole::ForwardValid => output.forward_valid.into(),
                    PortRole::ForwardPixel => output.forward_pixel.into(),
                    PortRole::Clock
                    | PortRole::Reset
                    | PortRole::Valid
                    | PortRole::StartOfFrame
                    | PortRole::Pixel
                    | PortRole::Border
                    | PortRole::Level(_)
                    | PortRole::MinScore(_)
                    | PortRole::TemporalLevel
                    | PortRole::TemporalMinCount
                    | PortRole::Ready
                    | PortRole::ReferenceValid
                    | PortRole::ReferencePixel
                    | PortRole::ReferenceReady
                    | PortRole::StoreValid
                    | PortRole::StorePixel
                    | PortRole::StoreLast
                    | PortRole::Underrun
                    | PortRole::ScoreValid
                    | PortRole::ScoreIndex
                    | PortRole::Region
                    | PortRole::AnyScore
                    | PortRole::ForwardPosition
                    | PortRole::ForwardSlot
                    | PortRole::ForwardRegion
                    | PortRole::ForwardReady
                    | PortRole::ForwardFirst
                    | PortRole::ForwardLast
                    | PortRole::ForwardAbort
                    | PortRole::ForwardFrame
                    | PortRole::Lost
                    | PortRole::LostCount
                    | PortRole::LostValid
                    | PortRole::LostRegion
                    | PortRole::LostFrame => continue,
                };
                field.set(record, lane, value);
            }
        }
    }
}
