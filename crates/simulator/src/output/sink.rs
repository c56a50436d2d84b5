// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where outcomes go: anything that takes frames one at a time and is finished once.

use std::path::PathBuf;

use foveate_camera::Camera;
use foveate_engine::{Engine, FrameOutcome};
use foveate_frame::Plane;

use crate::SimulatorError;
use foveate_footage::SourceFrame;

/// One frame and what came of it.
pub(super) struct Step<'a> {
    pub(super) camera: &'a Camera,
    /// Number of the frame in the run.
    pub(super) number: u64,
    pub(super) source: &'a SourceFrame,
    pub(super) outcome: &'a FrameOutcome,
    /// What is on the screen.
    pub(super) screen: Plane<'a>,
    /// Whether it is the first since the camera forgot what was before.
    pub(super) first: bool,
    /// What the camera computed besides; none of a recording.
    pub(super) engine: Option<&'a Engine>,
}

impl<'a> Step<'a> {
    /// The last step of `engine`, which took `source`.
    pub(super) fn new(
        engine: &'a Engine,
        number: u64,
        source: &'a SourceFrame,
        first: bool,
    ) -> Self {
        let (camera, outcome) = (engine.camera(), engine.outcome());
        let screen = engine.rendered();
        Self { camera, number, source, outcome, screen, first, engine: Some(engine) }
    }
}

/// An output that grows frame by frame in constant memory. Sinks of one run work side by side.
///
/// A full disk comes up in [`Sink::write_out`], which is asked before a frame is taken: so either all
/// sinks take a frame or none does, and what they have taken is still there to be written.
pub(super) trait Sink: Send {
    /// Takes what there is to say about the next frame.
    fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError>;

    /// Writes what has gathered if it is much, or `all` of it.
    fn write_out(&mut self, all: bool) -> Result<(), SimulatorError>;

    /// At most how many bytes, beside some buffers, may have to be written after a full disk.
    fn owed(&self, _design: &Camera) -> u64 {
        0
    }

    /// A file or folder that is given up when there is no room to complete everything.
    fn expendable(&self) -> Option<PathBuf> {
        None
    }

    /// Whether another program writes it, as long as there is room.
    fn is_written_apart(&self) -> bool {
        false
    }

    /// Completes what was written; one that is dropped instead leaves something unfinished.
    fn finish(self: Box<Self>) -> Result<(), SimulatorError>;
}
