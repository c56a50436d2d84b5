// SPDX-License-Identifier: MIT OR Apache-2.0
//! One RPU, which is an array with a single lane.

use foveate_design::PipelinedDesign;

use super::ports::{RpuInput, RpuOutput};
use super::rpu_array::RpuArray;
use crate::ThresholdInputs;
use crate::thresholds::ClassThresholdInputs;

/// The cycle-level model of one RPU. A new one is in the state after a reset.
#[derive(Clone, Debug)]
pub struct PipelinedRpu {
    array: RpuArray,
}

impl PipelinedRpu {
    /// Makes an RPU of the design.
    #[must_use]
    pub fn new(design: PipelinedDesign<'_>) -> Self {
        Self { array: RpuArray::new(design, 1) }
    }

    /// Applies one rising edge, and returns every output after it, with these inputs still applied.
    /// In a design with zones the class of the region is [`foveate_camera::RegionClass::Normal`].
    pub fn step(&mut self, input: &RpuInput, thresholds: &ThresholdInputs) -> RpuOutput {
        let &RpuInput { reset, valid, pixel, border } = input;
        let thresholds = ClassThresholdInputs::new(thresholds, None);
        if reset {
            self.array.reset(thresholds);
        } else {
            let pixels = [pixel];
            self.array.step(valid.then_some(&pixels), (&[border], None), thresholds);
        }
        self.array.outputs()[0]
    }
}
