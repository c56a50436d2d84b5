// SPDX-License-Identifier: MIT OR Apache-2.0
//! The RCM: one RPU per region, all in step.

use foveate_design::PipelinedDesign;

use super::{PipelinedRpu, RcmInput, RpuInput, RpuOutput};
use crate::number::index;
use crate::{FrameSync, region_border};

/// The cycle-level model of an RCM, as after a reset when new.
#[derive(Clone, Debug)]
pub struct PipelinedRcm {
    sync: FrameSync,
    lanes: Vec<Lane>,
    outputs: Vec<RpuOutput>,
}

#[derive(Clone, Debug)]
struct Lane {
    rpu: PipelinedRpu,
    border: u8,
}

impl PipelinedRcm {
    /// The RCM of the design.
    #[must_use]
    pub fn new(design: PipelinedDesign<'_>) -> Self {
        let rpu = PipelinedRpu::new(design);
        let lane = |region| Lane { rpu: rpu.clone(), border: region_border(&design, region) };
        Self {
            sync: FrameSync::new(&design),
            lanes: (0..design.regions()).map(lane).collect(),
            outputs: vec![RpuOutput::default(); index(design.regions())],
        }
    }

    /// One rising edge: the pixel of region i in lane i of the pixels, its outputs in lane i of what
    /// is returned.
    ///
    /// # Panics
    /// When there is not one pixel per region.
    pub fn step(&mut self, input: &RcmInput<'_>) -> &[RpuOutput] {
        let &RcmInput { reset, valid, sof, pixels, thresholds } = input;
        assert_eq!(pixels.len(), self.lanes.len(), "one pixel per region is needed");
        let valid = if reset {
            self.sync.reset();
            false
        } else {
            self.sync.step(valid, sof, true)
        };
        for ((lane, &pixel), output) in self.lanes.iter_mut().zip(pixels).zip(&mut self.outputs) {
            let input = RpuInput { reset, valid, pixel, border: lane.border };
            *output = lane.rpu.step(&input, thresholds);
        }
        &self.outputs
    }

    /// What the outputs show after the last edge, those of region i in lane i.
    #[must_use]
    pub fn outputs(&self) -> &[RpuOutput] {
        &self.outputs
    }

    /// What `sync_error_o` shows after the last edge.
    #[must_use]
    pub fn sync_error(&self) -> bool {
        self.sync.is_error()
    }
}
