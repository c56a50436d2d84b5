// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level models of a design of any organization.

use foveate_design::{Design, Hardware};

use crate::{CycleModel, PipelinedRcm, RasterRcm, SerialRcm};

/// Returns the model of module `rcm` in the state after a reset.
#[must_use]
pub fn rcm_model(design: &Design) -> Box<dyn CycleModel> {
    match design.hardware() {
        Hardware::Pipelined(own) => Box::new(PipelinedRcm::new(design.with_hardware(own))),
        Hardware::Serial(own) => Box::new(SerialRcm::new(design.with_hardware(own))),
        Hardware::Raster(own) => Box::new(RasterRcm::new(design.with_hardware(own))),
    }
}

/// Returns the model of module `rpu` in the state after a reset. If the RPU is not a part of the
/// array, it is the model of a design with [one unit](Design::lone_unit).
#[must_use]
pub fn rpu_model(design: &Design) -> Box<dyn CycleModel> {
    match design.hardware() {
        Hardware::Pipelined(own) => Box::new(PipelinedRcm::lone_rpu(design.with_hardware(own))),
        Hardware::Serial(_) | Hardware::Raster(_) => rcm_model(design),
    }
}
