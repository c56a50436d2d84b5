// SPDX-License-Identifier: MIT OR Apache-2.0
//! The array as its callers see it.

use foveate_design::{PipelinedDesign, bits_for};
use foveate_lanes::Level;
use foveate_model::Thresholds;

use crate::core::{Clock, Core, Edge};
use crate::plan::index;
use crate::view::Outputs;
use crate::wide::{Bytes, Narrow, Words};

/// An RCM of pipelined RPUs, as after a reset when new: what [`foveate_model::PipelinedRcm`] shows
/// after every edge, fast. It takes whole frames: [`foveate_model::FrameSync`] finds them, in front of it.
#[derive(Clone, Debug)]
pub struct PipelinedArray {
    core: Cores,
    level: Level,
    regions: usize,
}

#[derive(Clone, Debug)]
enum Cores {
    Narrow(Box<Core<Narrow>>),
    Bytes(Box<Core<Bytes>>),
    Words(Box<Core<Words>>),
}

impl PipelinedArray {
    /// The array of the design, with the best vector instructions of this processor.
    #[must_use]
    pub fn new(design: PipelinedDesign<'_>) -> Self {
        Self::with_level(design, Level::detect())
    }

    /// The array of the design, with these instructions.
    #[must_use]
    pub fn with_level(design: PipelinedDesign<'_>, level: Level) -> Self {
        let core = match design.pixel_bits() {
            0..=8 if fits_narrow(design) => Cores::Narrow(Box::new(Core::new(design))),
            0..=8 => Cores::Bytes(Box::new(Core::new(design))),
            _ => Cores::Words(Box::new(Core::new(design))),
        };
        Self { core, level, regions: index(design.regions()) }
    }

    /// The vector instructions in use.
    #[must_use]
    pub fn level(&self) -> Level {
        self.level
    }

    /// One rising edge: the pixel of region i in lane i of `pixels`. Without `valid`, `pixels` are not
    /// looked at.
    ///
    /// # Panics
    /// When there is not one pixel per region.
    pub fn step(
        &mut self,
        reset: bool,
        valid: bool,
        pixels: &[u16],
        thresholds: &Thresholds,
    ) -> Outputs<'_> {
        assert_eq!(pixels.len(), self.regions, "one pixel per region is needed");
        self.clock(Edge { reset, valid, pixels, thresholds })
    }

    /// As [`PipelinedArray::step`], for pixels of up to 8 bits that lie in memory as bytes.
    ///
    /// # Panics
    /// When there is not one pixel per region.
    pub fn step_u8(
        &mut self,
        reset: bool,
        valid: bool,
        pixels: &[u8],
        thresholds: &Thresholds,
    ) -> Outputs<'_> {
        assert_eq!(pixels.len(), self.regions, "one pixel per region is needed");
        self.clock(Edge { reset, valid, pixels, thresholds })
    }

    fn clock<P: Copy>(&mut self, edge: Edge<'_, P>) -> Outputs<'_>
    where
        u8: crate::core::From8Or16<P>,
        u16: crate::core::From8Or16<P>,
    {
        match &mut self.core {
            Cores::Narrow(core) => self.level.run(Clock { core, edge }),
            Cores::Bytes(core) => self.level.run(Clock { core, edge }),
            Cores::Words(core) => self.level.run(Clock { core, edge }),
        }
        self.outputs()
    }

    /// Every output port as it is after the last edge.
    #[must_use]
    pub fn outputs(&self) -> Outputs<'_> {
        match &self.core {
            Cores::Narrow(core) => Outputs::of(&**core, self.regions),
            Cores::Bytes(core) => Outputs::of(&**core, self.regions),
            Cores::Words(core) => Outputs::of(&**core, self.regions),
        }
    }
}

/// Whether counts fit into bytes, and sums and scores into 32 bits.
fn fits_narrow(design: PipelinedDesign<'_>) -> bool {
    let n = u64::from(design.region_pixels());
    let max = u64::from(design.pixel_max());
    let widest = design
        .features()
        .iter()
        .map(|feature| feature.score_bits())
        .max()
        .expect("a design has a feature");
    let fraction_bits = design.features().iter().find_map(|feature| feature.mean());
    let fraction_bits = fraction_bits.map_or(0, |mean| mean.fraction_bits);
    n <= 255
        && widest <= 32
        && bits_for(n * max * max) <= 32
        && bits_for(n * max) + fraction_bits <= 32
}
