// SPDX-License-Identifier: MIT OR Apache-2.0
//! The request of an exploration.

use std::path::PathBuf;

use foveate_footage::InputOptions;

use crate::{DesignSpace, Synthesizer};

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
    /// The synthesizer, for areas; without it the figures have no areas.
    pub synthesizer: Option<&'a Synthesizer>,
}
