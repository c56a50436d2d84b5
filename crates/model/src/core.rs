// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level models of a design of any organization.

use foveate_design::{Design, Hardware};

use crate::{CycleModel, PipelinedRcm, RasterRcm, SerialRcm};

/// Returns the model of module `rcm` in the state after a reset.
#[must_use]
pub fn rcm(design: &Design) -> Box<dyn CycleModel> {
    match design.hardware() {
        Hardware::Pipelined(own) => Box::new(PipelinedRcm::new(design.on(own))),
        Hardware::Serial(own) => Box::new(SerialRcm::new(design.on(own))),
        Hardware::Raster(own) => Box::new(RasterRcm::new(design.on(own))),
    }
}

/// Returns the model of module `rpu` in the state after a reset. If the RPU is not a part of the
/// array, it is the model of a design with [one unit](Design::lone_unit).
#[must_use]
pub fn rpu(design: &Design) -> Box<dyn CycleModel> {
    match design.hardware() {
        Hardware::Pipelined(own) => Box::new(PipelinedRcm::lone(design.on(own))),
        Hardware::Serial(_) | Hardware::Raster(_) => rcm(design),
    }
}
