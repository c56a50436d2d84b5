// SPDX-License-Identifier: MIT OR Apache-2.0
//! The numbers from which the clocks of a core of any organization follow, and which also make
//! the core ([`CoreTiming`]).

use crate::pipelined::PipelinedCore;
use crate::raster::RasterCore;
use crate::serial::SerialCore;
use crate::timed_core::TimedCore;
use foveate_design::{Design, Hardware, PipelinedTiming, RasterTiming, SerialTiming};

/// The timing of a core: the numbers from which all clocks follow.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub enum CoreTiming {
    /// The timing of a pipelined array.
    Pipelined(PipelinedTiming),
    /// The timing of a serial array.
    Serial(SerialTiming),
    /// The timing of a raster core.
    Raster(RasterTiming),
}

impl CoreTiming {
    /// Returns the timing of the design.
    #[must_use]
    pub fn from_design(design: &Design) -> Self {
        match design.hardware() {
            Hardware::Pipelined(own) => {
                Self::Pipelined(PipelinedTiming::from_design(design.with_hardware(own)))
            }
            Hardware::Serial(own) => {
                Self::Serial(SerialTiming::from_design(design.with_hardware(own)))
            }
            Hardware::Raster(own) => {
                Self::Raster(RasterTiming::from_design(design.with_hardware(own)))
            }
        }
    }

    /// Makes the core of the design with this timing, which may be that of another design.
    pub(crate) fn core(self, design: &Design) -> Box<dyn TimedCore> {
        match (self, design.hardware()) {
            (Self::Pipelined(timing), Hardware::Pipelined(_)) => {
                Box::new(PipelinedCore::new(design, timing))
            }
            (Self::Serial(timing), Hardware::Serial(own)) => {
                Box::new(SerialCore::new(design.with_hardware(own), timing))
            }
            (Self::Raster(timing), Hardware::Raster(_)) => Box::new(RasterCore::new(timing)),
            (Self::Pipelined(_), Hardware::Serial(_) | Hardware::Raster(_))
            | (Self::Serial(_), Hardware::Pipelined(_) | Hardware::Raster(_))
            | (Self::Raster(_), Hardware::Pipelined(_) | Hardware::Serial(_)) => {
                panic!("the timing is that of another organization")
            }
        }
    }
}
