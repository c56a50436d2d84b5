// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of outputs that take frames one at a time and are finished once.

use std::path::PathBuf;

use foveate_camera::Camera;
use foveate_engine::{Engine, FrameOutcome};
use foveate_pixels::FramePixels;

use crate::SimulatorError;
use foveate_media::SourceFrame;

/// One frame and its outcome.
pub(super) struct SinkFrame<'a> {
    pub(super) camera: &'a Camera,
    /// The number of the frame in the run.
    pub(super) number: u64,
    pub(super) source: &'a SourceFrame,
    /// The version of the map of classes in the FRAME of a recording, or `None` for a simulation or
    /// a design without zones.
    pub(super) map_version: Option<u16>,
    pub(super) outcome: &'a FrameOutcome,
    pub(super) screen: FramePixels<'a>,
    /// True if the frame is the first one after a reset of the camera.
    pub(super) is_first: bool,
    /// The engine that computed the outcome, or `None` for a recording.
    pub(super) engine: Option<&'a Engine>,
}

impl<'a> SinkFrame<'a> {
    /// Describes the frame `source`, which must be the last frame that `engine` took.
    pub(super) fn new(
        engine: &'a Engine,
        number: u64,
        source: &'a SourceFrame,
        is_first: bool,
    ) -> Self {
        let (camera, outcome) = (engine.camera(), engine.outcome());
        let screen = engine.rendered();
        let (map_version, engine) = (None, Some(engine));
        Self { camera, number, source, map_version, outcome, screen, is_first, engine }
    }
}

/// An output that grows frame by frame in constant memory. The sinks of one run work in parallel.
///
/// A full disk is noticed in [`FrameSink::write_out`], which is called before a frame is taken. So
/// either all sinks take a frame or none does, and the data that they have taken can still be
/// written.
pub(super) trait FrameSink: Send {
    /// Takes the next frame.
    fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError>;

    /// Writes the buffered data if there is much of it. On a full disk they stay in memory.
    fn write_out(&mut self) -> Result<(), SimulatorError>;

    /// Returns the largest number of bytes of pictures that may have to be written after the disk is
    /// full.
    fn max_bytes_owed(&self, _camera: &Camera) -> u64 {
        0
    }

    /// Returns the file or folder that is left out if there is no space to complete it.
    fn expendable_path(&self) -> Option<PathBuf> {
        None
    }

    /// Writes all buffered data and completes the output.
    fn finish(self: Box<Self>) -> Result<(), SimulatorError>;
}
