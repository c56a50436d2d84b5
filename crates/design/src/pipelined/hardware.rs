// SPDX-License-Identifier: MIT OR Apache-2.0
//! The properties of a pipelined array.

use crate::{HardwareConfig, Organization, Pipelining};

/// The properties that only a pipelined array has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PipelinedHardware {
    /// The number of registers in the arithmetic.
    pub pipelining: Pipelining,
}

impl PipelinedHardware {
    /// Returns the properties that a configuration asks for.
    pub(crate) fn new(asked: &HardwareConfig) -> Self {
        Self { pipelining: asked.pipelining.unwrap_or_default() }
    }

    /// Returns the table `[hardware]`. A default is left out, so that the fingerprint of a design
    /// is the same as before the key existed.
    pub(crate) fn config(&self) -> HardwareConfig {
        HardwareConfig {
            organization: Organization::Pipelined,
            pipelining: self.pipelining.non_default(),
            ..HardwareConfig::default()
        }
    }
}
