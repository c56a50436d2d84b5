// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cycle-level model of a design, whatever its organization.

use foveate_design::{Design, Hardware};

use crate::{CycleModel, PipelinedRcm, RasterRcm, SerialRcm};

/// The model of module `rcm`, as after a reset.
#[must_use]
pub fn rcm(design: &Design) -> Box<dyn CycleModel> {
    match design.hardware() {
        Hardware::Pipelined(own) => Box::new(PipelinedRcm::new(design.on(own))),
        Hardware::Serial(own) => Box::new(SerialRcm::new(design.on(own))),
        Hardware::Raster(own) => Box::new(RasterRcm::new(design.on(own))),
    }
}

/// The model of module `rpu`, as after a reset: where that is no part of the array, of a design of
/// [one unit](Design::lone_unit).
#[must_use]
pub fn rpu(design: &Design) -> Box<dyn CycleModel> {
    match design.hardware() {
        Hardware::Pipelined(own) => Box::new(PipelinedRcm::lone(design.on(own))),
        Hardware::Serial(_) | Hardware::Raster(_) => rcm(design),
    }
}
