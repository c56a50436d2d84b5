// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the blocks of an array need to know of the design, taken from it once.

use foveate_design::{
    Combine, FeatureKind, Filter, Irrelevant, Neighborhood, Payload, PipelinedDesign,
    PipelinedTiming, Reference, Thresholds as Source,
};
use foveate_model::Thresholds;

/// Parameters of every RPU.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// RPUs.
    pub(crate) lanes: usize,
    /// Pixels of a region n.
    pub(crate) pixels: usize,
    pub(crate) neighborhood: Neighborhood,
    /// Side of the square that comes in.
    pub(crate) stream_side: usize,
    /// Side of the square that the feature window takes.
    pub(crate) denoised_side: usize,
    pub(crate) denoises: bool,
    pub(crate) feature_window: bool,
    pub(crate) needs_border: bool,
    /// Whether raw pixels travel beside denoised ones.
    pub(crate) keeps_raw: bool,
    /// Registers between the median window and the next stage.
    pub(crate) median_registers: usize,
    /// Registers in front of the tail.
    pub(crate) tail_delay: usize,
    /// In the order of the design.
    pub(crate) features: Vec<FeatureKind>,
    pub(crate) fraction_bits: u32,
    pub(crate) second_pass: bool,
    pub(crate) combine: Combine,
    pub(crate) reference: Reference,
    pub(crate) irrelevant: Irrelevant,
    /// The thresholds, where they are constants of the core.
    constants: Option<Thresholds>,
}

impl Plan {
    pub(crate) fn of(design: PipelinedDesign<'_>) -> Self {
        let features: Vec<_> = design.features().iter().map(|feature| feature.kind()).collect();
        let timing = PipelinedTiming::of(design);
        let mean = design.features().iter().find_map(|feature| feature.mean());
        Self {
            lanes: index(design.regions()),
            pixels: index(design.region_pixels()),
            neighborhood: design.neighborhood(),
            stream_side: index(design.stream_side()),
            denoised_side: index(design.denoised_side()),
            denoises: design.filter() != Filter::None,
            feature_window: design.has_feature_window(),
            needs_border: design.needs_border(),
            keeps_raw: design.filter() != Filter::None && design.payload() == Payload::Raw,
            median_registers: index(timing.median_registers),
            tail_delay: index(timing.tail_delay),
            features,
            fraction_bits: mean.map_or(0, |mean| mean.fraction_bits),
            second_pass: design.has_second_pass(),
            combine: design.combine(),
            reference: design.temporal().reference,
            irrelevant: design.irrelevant(),
            constants: match design.thresholds() {
                Source::Runtime => None,
                Source::Constant => Some(Thresholds::of(&design)),
            },
        }
    }

    /// The thresholds that the cores see: their inputs, or their constants.
    pub(crate) fn seen(&self, applied: &Thresholds) -> Thresholds {
        self.constants.unwrap_or(*applied)
    }

    /// The place of a feature in the design.
    pub(crate) fn place(&self, kind: FeatureKind) -> Option<usize> {
        self.features.iter().position(|&feature| feature == kind)
    }
}

/// A number of the design as an index.
pub(crate) fn index(value: u32) -> usize {
    usize::try_from(value).expect("an index has 32 bits or more")
}
