// SPDX-License-Identifier: MIT OR Apache-2.0
//! The RCM: one RPU per region, all clocked together.

use foveate_camera::FeatureKind;
use foveate_design::{PipelinedDesign, PortRole};

use super::RpuOutput;
use super::rpu_array::RpuArray;
use crate::conversions::index;
use crate::cycle_model::{CoreInput, CycleModel};
use crate::thresholds::ClassThresholdInputs;
use crate::{FrameSync, region_border};

/// The cycle-level model of an RCM. A new one is in the state after a reset.
#[derive(Clone, Debug)]
pub struct PipelinedRcm {
    feature_kinds: Vec<FeatureKind>,
    sync: FrameSync,
    rpus: RpuArray,
    /// The borders of every region, or `None` for a lone RPU, whose borders are an input.
    borders: Option<Vec<u8>>,
}

impl PipelinedRcm {
    /// Makes the RCM of the design.
    #[must_use]
    pub fn new(design: PipelinedDesign<'_>) -> Self {
        let borders = (0..design.regions()).map(|region| region_border(&design, region)).collect();
        Self {
            feature_kinds: design.feature_kinds(),
            sync: FrameSync::new(&design),
            rpus: RpuArray::new(design, index(design.regions())),
            borders: Some(borders),
        }
    }

    /// Makes module `rpu`: one RPU of the design, whose borders are an input. It has no logic that
    /// finds frames.
    #[must_use]
    pub fn lone_rpu(design: PipelinedDesign<'_>) -> Self {
        Self {
            feature_kinds: design.feature_kinds(),
            sync: FrameSync::without_sync(),
            rpus: RpuArray::new(design, 1),
            borders: None,
        }
    }

    /// Applies one rising edge, and returns the outputs of all regions. Element i of the pixels and
    /// of the outputs belongs to region i.
    ///
    /// # Panics
    /// Panics if there is not one pixel per region, or not one class per region.
    pub fn step(&mut self, input: &CoreInput<'_>) -> &[RpuOutput] {
        let &CoreInput { reset, valid, sof, pixels, thresholds, zones, .. } = input;
        assert_eq!(pixels.len(), self.rpus.lanes(), "one pixel per region is needed");
        let thresholds = ClassThresholdInputs::new(thresholds, zones);
        if reset {
            self.sync.reset();
            self.rpus.reset(thresholds);
        } else {
            let valid = self.sync.step(valid, sof, true);
            let borders = self.borders.as_deref().unwrap_or(std::slice::from_ref(&input.border));
            let classes = zones.map(|zones| zones.classes);
            self.rpus.step(valid.then_some(pixels), (borders, classes), thresholds);
        }
        self.outputs()
    }

    /// Returns the outputs after the last edge. Element i belongs to region i.
    #[must_use]
    pub fn outputs(&self) -> &[RpuOutput] {
        self.rpus.outputs()
    }

    /// Returns `sync_error_o` after the last edge.
    #[must_use]
    pub fn sync_error(&self) -> bool {
        self.sync.is_error()
    }

    fn append_lanes(&self, values: &mut Vec<u64>, value: impl Fn(&RpuOutput) -> u64) {
        values.extend(self.outputs().iter().map(value));
    }
}

impl CycleModel for PipelinedRcm {
    fn clock(&mut self, input: &CoreInput<'_>) {
        self.step(input);
    }

    fn append_output(&self, role: PortRole, values: &mut Vec<u64>) {
        match role {
            PortRole::SyncError => values.push(self.sync_error().into()),
            // All lanes decide in the same clock.
            PortRole::DecisionValid => values.push(self.outputs()[0].decision_valid.into()),
            PortRole::Srs => self.append_lanes(values, |shown| shown.srs.into()),
            PortRole::Trs => self.append_lanes(values, |shown| shown.trs.into()),
            PortRole::Active => self.append_lanes(values, |shown| shown.active.into()),
            PortRole::Summary => self.append_lanes(values, |shown| shown.summary.into()),
            PortRole::Score(kind) => {
                if let Some(place) =
                    self.feature_kinds.iter().position(|&feature_kind| feature_kind == kind)
                {
                    self.append_lanes(values, |shown| shown.scores[place]);
                }
            }
            PortRole::TemporalCount => {
                self.append_lanes(values, |shown| shown.temporal_count.into());
            }
            PortRole::ForwardValid => self.append_lanes(values, |shown| shown.forward_valid.into()),
            PortRole::ForwardPixel => self.append_lanes(values, |shown| shown.forward_pixel.into()),
            // The other roles are inputs, or outputs that an RCM does not have.
            _ => {}
        }
    }

    fn is_ready(&self) -> bool {
        true
    }

    fn reference(&self, _region: u32) -> Option<&[u16]> {
        None
    }

    fn summary(&self, _region: u32) -> Option<&[u16]> {
        None
    }

    fn duplicate(&self) -> Box<dyn CycleModel> {
        Box::new(self.clone())
    }
}
