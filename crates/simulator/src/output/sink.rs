// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where outcomes go: anything that takes frames one at a time and is finished once.

use std::sync::OnceLock;

use foveate_engine::{Engine, Outcome};
use foveate_model::Frame;
use foveate_spec::Design;

use crate::{SimulatorError, SourceFrame};

/// One frame and what came of it.
pub(super) struct Step<'a> {
    pub(super) design: &'a Design,
    /// Number of the frame in the run.
    pub(super) number: u64,
    pub(super) source: &'a SourceFrame,
    pub(super) outcome: &'a Outcome,
    engine: &'a Engine,
    rendered: OnceLock<Frame>,
}

impl<'a> Step<'a> {
    /// The last step of `engine`, which took `source`.
    pub(super) fn new(engine: &'a Engine, number: u64, source: &'a SourceFrame) -> Self {
        let (design, outcome) = (engine.design(), engine.outcome());
        Self { design, number, source, outcome, engine, rendered: OnceLock::new() }
    }

    /// What is on the screen; made when a sink asks for it first.
    pub(super) fn rendered(&self) -> Result<&Frame, SimulatorError> {
        if let Some(frame) = self.rendered.get() {
            return Ok(frame);
        }
        let words = self.engine.rendered().to_words();
        let (width, height) = (self.design.width(), self.design.height());
        let frame = Frame::new(width, height, self.design.pixel_bits(), words)?;
        Ok(self.rendered.get_or_init(|| frame))
    }
}

/// An output that grows frame by frame in constant memory. Sinks of one run work side by side.
pub(super) trait Sink: Send {
    /// Writes what there is to say about the next frame.
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError>;

    /// Completes what was written; one that is dropped instead leaves something unfinished.
    fn finish(self: Box<Self>) -> Result<(), SimulatorError>;
}
