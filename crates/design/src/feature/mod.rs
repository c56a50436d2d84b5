// SPDX-License-Identifier: MIT OR Apache-2.0
//! The hardware of features, one file for each feature: latencies, steps, registers, memories and
//! rough sizes in every organization that computes the score ([`FeatureHardware`]).

mod corner;
mod description;
mod edge;
mod flow;
mod mad;
mod range;
mod segment;
mod surface;
mod variance;

pub use description::FeatureDescription;
pub use flow::FlowSearch;

use crate::{Design, Organization, Pipelining};
use foveate_camera::{FeatureKind, SpatialFeature};

/// The hardware of a feature. An organization that does not compute the score has `None`.
#[derive(Debug)]
pub struct FeatureHardware {
    /// In `pipelined`.
    pub pipelined: Option<PipelinedFeature>,
    /// In `serial`.
    pub serial: Option<SerialFeature>,
    /// In `raster`.
    pub raster: Option<RasterFeature>,
}

/// The hardware of a feature in a pipelined RPU.
#[derive(Debug)]
pub struct PipelinedFeature {
    /// Clocks from the step of the last pixel of a frame until the score is final, with `plain`
    /// pipelining. For a feature with a second pass, the clocks end when the value that the second
    /// pass starts with is final.
    pub(crate) plain_latency: u32,
    /// The same clocks with `deep` pipelining.
    pub(crate) deep_latency: u32,
    /// Roughly the LUTs of an RPU for each bit of a pixel.
    pub rough_luts: f64,
}

/// The hardware of a feature in a serial lane.
#[derive(Debug)]
pub struct SerialFeature {
    /// Returns the steps of the pass.
    pub(crate) pass_steps: fn(&Design, &SpatialFeature) -> u64,
    /// True if the lanes compute an operand from the word that they read: a difference from
    /// another word, or some of the bits of the word.
    pub(crate) computes_operand: bool,
    /// True if the score of a lane takes the accumulator, or is cleared with it.
    pub(crate) takes_accumulator: bool,
    /// Returns the bits that the word of the ring needs besides those of the score.
    pub(crate) chain_bits: fn(&Design) -> u32,
    /// Returns the widths of the registers.
    pub(crate) registers: fn(&Design, &SpatialFeature) -> FeatureRegisterWidths,
    /// Roughly the LUTs of a lane for each bit of a pixel.
    pub rough_luts: f64,
}

/// The hardware of a feature in a raster core.
#[derive(Debug)]
pub struct RasterFeature {
    /// Clocks from the sums or extremes of a region to its score; 0 if the score is one of them, or
    /// comes from the second pass, whose latency is counted separately.
    pub(crate) score_latency: u32,
    /// The memory of a row of regions that only this feature needs: what a word holds, and its
    /// bits.
    pub(crate) memory: Option<RowMemory>,
    /// Roughly the LUTs of a core for each bit of a pixel and each pixel of a word.
    pub rough_luts: f64,
}

/// The contents of a word of a memory, and the function that returns its bits.
pub(crate) type RowMemory = (&'static str, fn(&Design, &SpatialFeature) -> u32);

/// The widths of registers that a feature needs, in bits. A register that it does not use has 0.
#[derive(Default)]
pub(crate) struct FeatureRegisterWidths {
    pub(crate) accumulator: u32,
    pub(crate) second: u32,
    pub(crate) scale: u32,
}

impl FeatureHardware {
    /// Returns the hardware of a feature.
    #[must_use]
    pub fn of_kind(kind: FeatureKind) -> &'static Self {
        match kind {
            FeatureKind::Edge => &edge::HARDWARE,
            FeatureKind::Corner => &corner::HARDWARE,
            FeatureKind::Mad => &mad::HARDWARE,
            FeatureKind::Variance => &variance::HARDWARE,
            FeatureKind::Range => &range::HARDWARE,
            FeatureKind::Surface => &surface::HARDWARE,
            FeatureKind::Segment => &segment::HARDWARE,
            FeatureKind::Flow => &flow::HARDWARE,
        }
    }

    /// Returns the organizations that compute the score.
    pub fn organizations(&self) -> impl Iterator<Item = Organization> {
        Organization::ALL.iter().copied().filter(|&organization| self.is_in(organization))
    }

    /// Returns true if the organization computes the score.
    pub(crate) fn is_in(&self, organization: Organization) -> bool {
        match organization {
            Organization::Pipelined => self.pipelined.is_some(),
            Organization::Serial => self.serial.is_some(),
            Organization::Raster => self.raster.is_some(),
        }
    }

    /// Returns the hardware in `pipelined`, of a feature that a validated design has.
    ///
    /// # Panics
    /// Panics if `pipelined` does not compute the score.
    #[must_use]
    pub fn in_pipelined(kind: FeatureKind) -> &'static PipelinedFeature {
        Self::of_kind(kind).pipelined.as_ref().expect("the design was validated")
    }

    /// Returns the hardware in `serial`, of a feature that a validated design has.
    ///
    /// # Panics
    /// Panics if `serial` does not compute the score.
    #[must_use]
    pub fn in_serial(kind: FeatureKind) -> &'static SerialFeature {
        Self::of_kind(kind).serial.as_ref().expect("the design was validated")
    }

    /// Returns the hardware in `raster`, of a feature that a validated design has.
    ///
    /// # Panics
    /// Panics if `raster` does not compute the score.
    #[must_use]
    pub fn in_raster(kind: FeatureKind) -> &'static RasterFeature {
        Self::of_kind(kind).raster.as_ref().expect("the design was validated")
    }
}

impl PipelinedFeature {
    pub(crate) fn score_latency(&self, pipelining: Pipelining) -> u32 {
        match pipelining {
            Pipelining::Plain => self.plain_latency,
            Pipelining::Deep => self.deep_latency,
        }
    }
}
