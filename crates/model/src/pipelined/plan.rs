// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parameters of the blocks, taken from the design once.

use foveate_design::{
    Combine, FeatureKind, Filter, Irrelevant, Neighborhood, Payload, Periphery, PipelinedDesign,
    PipelinedTiming, Reference, SpatialFeature,
};

use crate::Thresholds;
use crate::number::index;

/// Most features that a design can have.
pub(super) const FEATURES: usize = FeatureKind::COUNT;

/// What the blocks of one RPU need to know of the design.
#[derive(Clone, Copy, Debug)]
pub(super) struct RpuPlan {
    /// Side of a region N.
    pub(super) side: usize,
    /// Pixels of a region n.
    pub(super) pixels: usize,
    pub(super) neighborhood: Neighborhood,
    /// Side of the square of pixels that comes in.
    pub(super) stream_side: usize,
    pub(super) filter: Filter,
    pub(super) has_feature_window: bool,
    pub(super) needs_border: bool,
    /// Registers between the median window and the next stage, m.
    pub(super) median_registers: usize,
    /// Registers between the last window and the tail, d.
    pub(super) tail_delay: usize,
    /// The features in the order of the design.
    pub(super) features: [Option<FeatureKind>; FEATURES],
    /// Fraction bits of the mean, where there is `mad`.
    pub(super) fraction_bits: u32,
    /// Whether the decision waits for one more frame.
    pub(super) second_pass: bool,
    pub(super) combine: Combine,
    pub(super) reference: Reference,
    pub(super) irrelevant: Irrelevant,
    pub(super) payload: Payload,
    /// What irrelevant regions send.
    pub(super) periphery: Option<Periphery>,
    /// The thresholds, where they are constants of the core.
    constants: Option<Thresholds>,
}

impl RpuPlan {
    pub(super) fn of(design: PipelinedDesign<'_>) -> Self {
        let mut features = [None; FEATURES];
        for (place, feature) in features.iter_mut().zip(design.features()) {
            *place = Some(feature.kind());
        }
        let timing = PipelinedTiming::of(design);
        let deviations = |feature: &SpatialFeature| match feature.kind() {
            FeatureKind::Edge | FeatureKind::Corner | FeatureKind::Variance => None,
            FeatureKind::Mad => feature.mean().map(|mean| mean.fraction_bits),
        };
        let fraction_bits = design.features().iter().find_map(deviations);
        Self {
            side: index(design.region_size()),
            pixels: index(design.region_pixels()),
            neighborhood: design.neighborhood(),
            stream_side: index(design.stream_side()),
            filter: design.filter(),
            has_feature_window: design.has_feature_window(),
            needs_border: design.needs_border(),
            median_registers: index(timing.median_registers),
            tail_delay: index(timing.tail_delay),
            features,
            fraction_bits: fraction_bits.unwrap_or(0),
            second_pass: design.has_second_pass(),
            combine: design.combine(),
            reference: design.temporal().reference,
            irrelevant: design.irrelevant(),
            payload: design.payload(),
            periphery: design.periphery().copied(),
            constants: Thresholds::constants(&design),
        }
    }

    /// The thresholds that the core sees: its inputs, or its constants where it has no such inputs.
    pub(super) fn seen<'a>(&'a self, applied: &'a Thresholds) -> &'a Thresholds {
        self.constants.as_ref().unwrap_or(applied)
    }
}
