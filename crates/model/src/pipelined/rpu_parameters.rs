// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parameters of the blocks of an RPU, which are taken from the design once.

use foveate_camera::{
    DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, Payload, Periphery,
    ReferencePolicy, VoteCombination,
};
use foveate_design::{PipelinedDesign, PipelinedTiming};

use crate::conversions::index;
use crate::thresholds::{ClassThresholdInputs, ThresholdConstants};

/// Largest number of features of a design.
pub(super) const MAX_FEATURES: usize = FeatureKind::COUNT;

/// The parameters of the design that the blocks of one RPU need.
#[derive(Clone, Copy, Debug)]
pub(super) struct RpuParameters {
    /// Side of a region N in pixels.
    pub(super) side: usize,
    /// Number of pixels of a region, n.
    pub(super) pixels: usize,
    pub(super) neighborhood: Neighborhood,
    /// Side of the square of pixels that is streamed.
    pub(super) stream_side: usize,
    pub(super) filter: DenoiseFilter,
    pub(super) has_feature_window: bool,
    /// True if a score needs sums or extremes over the pixels of a region.
    pub(super) needs_sums: bool,
    pub(super) needs_border: bool,
    /// Number of registers between the filter window and the next stage, m.
    pub(super) filter_registers: usize,
    /// Number of registers between the last window and the tail, d.
    pub(super) tail_delay: usize,
    /// The features in the order of the design.
    pub(super) features: [Option<FeatureKind>; MAX_FEATURES],
    /// Fraction bits of the mean of `mad` and `segment`, else 0.
    pub(super) fraction_bits: u32,
    /// True if the decision waits for one more frame.
    pub(super) second_pass: bool,
    pub(super) combine: VoteCombination,
    pub(super) reference: ReferencePolicy,
    pub(super) irrelevant: IrrelevantRendering,
    pub(super) payload: Payload,
    /// Parameters of the summaries, if irrelevant regions send them.
    pub(super) periphery: Option<Periphery>,
    /// The thresholds, if they are constants of the core.
    constants: Option<ThresholdConstants>,
}

impl RpuParameters {
    pub(super) fn from_design(design: PipelinedDesign<'_>) -> Self {
        let mut features = [None; MAX_FEATURES];
        for (place, feature) in features.iter_mut().zip(design.features()) {
            *place = Some(feature.kind());
        }
        let timing = PipelinedTiming::from_design(design);
        Self {
            side: index(design.region_size()),
            pixels: index(design.region_pixels()),
            neighborhood: design.neighborhood(),
            stream_side: index(design.stream_side()),
            filter: design.filter(),
            has_feature_window: design.has_feature_window(),
            needs_sums: design.features().iter().any(|f| !f.kind().counts_window_hits()),
            needs_border: design.needs_border(),
            filter_registers: index(timing.filter_registers),
            tail_delay: index(timing.tail_delay),
            features,
            fraction_bits: design.second_pass_mean().map_or(0, |mean| mean.fraction_bits),
            second_pass: design.has_second_pass(),
            combine: design.combine(),
            reference: design.temporal().reference,
            irrelevant: design.irrelevant(),
            payload: design.payload(),
            periphery: design.periphery().copied(),
            constants: ThresholdConstants::of_design(&design),
        }
    }

    /// Returns n as a count of pixels.
    pub(super) fn pixel_count(&self) -> u32 {
        u32::try_from(self.pixels).expect("a region has at most 4096 pixels")
    }

    /// Returns the thresholds that the core uses: its constants if it has them, else the inputs.
    pub(super) fn effective_thresholds<'a>(
        &'a self,
        applied: ClassThresholdInputs<'a>,
    ) -> ClassThresholdInputs<'a> {
        self.constants.as_ref().map_or(applied, ThresholdConstants::by_class)
    }
}
