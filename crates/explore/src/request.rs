// SPDX-License-Identifier: MIT OR Apache-2.0
//! The request of an exploration.

use std::path::PathBuf;

use foveate_media::InputOptions;

use crate::{DesignSpace, Disturbance, Synthesizer, TargetProcess};

/// The request of an exploration.
#[derive(Clone, Debug)]
pub struct ExploreRequest<'a> {
    /// The designs.
    pub space: &'a DesignSpace,
    /// The clips and data sets, which have one size. Image files together are one clip; every other
    /// input is its own.
    pub inputs: &'a [PathBuf],
    /// The options for reading the inputs.
    pub input: &'a InputOptions,
    /// A disturbance of the frames that the designs see; the ideal camera sees the clips as they
    /// are.
    pub disturbance: Option<Disturbance>,
    /// The synthesis of the designs; without it the figures have no areas.
    pub synthesis: Option<SynthesisRequest<'a>>,
}

/// The synthesis of the designs of an exploration.
#[derive(Clone, Copy, Debug)]
pub struct SynthesisRequest<'a> {
    /// The synthesizer, for areas in LUTs.
    pub synthesizer: &'a Synthesizer,
    /// A process in whose cells designs are measured, too.
    pub process: Option<ProcessRequest<'a>>,
}

/// The measurement of designs in a process.
#[derive(Clone, Copy, Debug)]
pub struct ProcessRequest<'a> {
    /// The process.
    pub process: &'a TargetProcess,
    /// The frames per second of powers. Without it, no energy is measured; it takes half a minute
    /// for a design.
    pub energy_rate: Option<f64>,
}
