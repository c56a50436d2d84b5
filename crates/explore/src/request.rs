// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an exploration is asked to do.

use std::path::PathBuf;

use foveate_footage::InputOptions;

use crate::{Space, Synthesizer};

/// What is explored.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// The designs.
    pub space: &'a Space,
    /// Clips and sets of one size, one each; image files together are one clip.
    pub inputs: &'a [PathBuf],
    /// How they are read.
    pub input: &'a InputOptions,
    /// The synthesizer, for areas; without it the figures have no areas.
    pub synthesizer: Option<&'a Synthesizer>,
}
