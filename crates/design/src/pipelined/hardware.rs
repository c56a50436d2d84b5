// SPDX-License-Identifier: MIT OR Apache-2.0
//! The properties of a pipelined array.

use crate::Pipelining;

/// The properties that only a pipelined array has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PipelinedHardware {
    /// The number of registers in the arithmetic.
    pub pipelining: Pipelining,
}
