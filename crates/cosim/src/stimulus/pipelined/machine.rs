// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model behind one interface, and its values in records.

use crate::layout::Layout;
use foveate_design::{Design, FeatureKind, PortRole};
use foveate_model::{PipelinedRcm, PipelinedRpu, RpuInput, RpuOutput, Thresholds};

/// What is applied at one edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inputs<'a> {
    pub(crate) reset: bool,
    pub(crate) valid: bool,
    /// One pixel per lane.
    pub(crate) pixels: &'a [u16],
    pub(crate) border: u8,
    pub(crate) thresholds: Thresholds,
}

/// A model of one RPU or of an array of them.
#[derive(Clone, Debug)]
pub(crate) enum Machine {
    Rpu(Box<PipelinedRpu>),
    Rcm(PipelinedRcm),
}

impl Machine {
    pub(crate) fn step(&mut self, inputs: &Inputs<'_>, outputs: &mut Vec<RpuOutput>) {
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
            }
            Self::Rcm(rcm) => outputs.extend_from_slice(rcm.step(
                inputs.reset,
                inputs.valid,
                inputs.pixels,
                &inputs.thresholds,
            )),
        }
    }
}

/// Puts values of pipelined models into records.
#[derive(Clone, Debug)]
pub struct PipelinedCodec {
    kinds: Vec<FeatureKind>,
}

impl PipelinedCodec {
    /// The codec of a design.
    #[must_use]
    pub fn new(design: &Design) -> Self {
        Self { kinds: design.features().iter().map(|feature| feature.kind()).collect() }
    }

    fn index(&self, kind: FeatureKind) -> usize {
        self.kinds
            .iter()
            .position(|&own| own == kind)
            .expect("a port is of a feature of the design")
    }

    pub(crate) fn inputs(&self, layout: &Layout, inputs: &Inputs<'_>, record: &mut [u8]) {
        let thresholds = &inputs.thresholds;
        for field in layout.fields() {
            let value = match field.port.role {
                PortRole::Reset => inputs.reset.into(),
                PortRole::Valid => inputs.valid.into(),
                PortRole::Border => inputs.border.into(),
                PortRole::Level(kind) => thresholds.level[self.index(kind)].into(),
                PortRole::MinScore(kind) => thresholds.min_score[self.index(kind)],
                PortRole::TemporalLevel => thresholds.temporal_level.into(),
                PortRole::TemporalMinCount => thresholds.temporal_min_count.into(),
                PortRole::Pixel => {
                    for (lane, &pixel) in (0..field.port.lanes).zip(inputs.pixels) {
                        field.set(record, lane, pixel.into());
                    }
                    continue;
                }
                PortRole::Clock
                | PortRole::DecisionValid
                | PortRole::Srs
                | PortRole::Trs
                | PortRole::Active
                | PortRole::Score(_)
                | PortRole::TemporalCount
                | PortRole::ForwardValid
                | PortRole::ForwardPixel
                | PortRole::Ready
                | PortRole::ScoreValid
                | PortRole::ScoreIndex
                | PortRole::Region
                | PortRole::AnyScore
                | PortRole::ForwardPosition
                | PortRole::ForwardSlot
                | PortRole::ForwardRegion => continue,
            };
            field.set(record, 0, value);
        }
    }

    /// The outputs of all RPUs after an edge.
    pub fn outputs(&self, layout: &Layout, outputs: &[RpuOutput], record: &mut [u8]) {
        for field in layout.fields() {
            for (lane, output) in (0..field.port.lanes).zip(outputs) {
                let value = match field.port.role {
                    PortRole::DecisionValid => output.decision_valid.into(),
                    PortRole::Srs => output.srs.into(),
                    PortRole::Trs => output.trs.into(),
                    PortRole::Active => output.active.into(),
                    PortRole::Score(kind) => output.scores[self.index(kind)],
                    PortRole::TemporalCount => output.temporal_count.into(),
                    PortRole::ForwardValid => output.forward_valid.into(),
                    PortRole::ForwardPixel => output.forward_pixel.into(),
                    PortRole::Clock
                    | PortRole::Reset
                    | PortRole::Valid
                    | PortRole::Pixel
                    | PortRole::Border
                    | PortRole::Level(_)
                    | PortRole::MinScore(_)
                    | PortRole::TemporalLevel
                    | PortRole::TemporalMinCount
                    | PortRole::Ready
                    | PortRole::ScoreValid
                    | PortRole::ScoreIndex
                    | PortRole::Region
                    | PortRole::AnyScore
                    | PortRole::ForwardPosition
                    | PortRole::ForwardSlot
                    | PortRole::ForwardRegion => continue,
                };
                field.set(record, lane, value);
            }
        }
    }
}
