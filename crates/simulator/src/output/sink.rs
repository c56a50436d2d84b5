// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where outcomes go: anything that takes frames one at a time and is finished once.

use foveate_model::Outcome;
use foveate_spec::Design;

use crate::{SimulatorError, SourceFrame};

/// One frame and what came of it.
pub(super) struct Step<'a> {
    pub(super) design: &'a Design,
    /// Number of the frame in the run.
    pub(super) number: u64,
    pub(super) source: &'a SourceFrame,
    pub(super) outcome: &'a Outcome,
}

/// An output that grows frame by frame in constant memory. Sinks of one run work side by side.
pub(super) trait Sink: Send {
    /// Writes what there is to say about the next frame.
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError>;

    /// Completes what was written; one that is dropped instead leaves something unfinished.
    fn finish(self: Box<Self>) -> Result<(), SimulatorError>;
}
