// SPDX-License-Identifier: MIT OR Apache-2.0
//! The receiver of a camera over a clip.

use foveate_camera::Camera;
use foveate_engine::Engine;
use foveate_footage::FrameSource;
use foveate_frame::FramePixels;

use crate::depths::FrameDepths;
use crate::footage::ExplorationFootage;
use crate::{ExploreError, ExploreProgress};

/// A camera that sees a clip, and its receiver.
pub(super) struct ClipReceiver<'a> {
    footage: &'a ExplorationFootage<'a>,
    source: Box<dyn FrameSource>,
    engine: Engine,
    /// The number of the next frame.
    next: u64,
}

impl<'a> ClipReceiver<'a> {
    pub(super) fn new(
        footage: &'a ExplorationFootage<'a>,
        clip: usize,
        camera: &Camera,
    ) -> Result<Self, ExploreError> {
        let source = footage.open(&footage.subjects[clip])?;
        Ok(Self { footage, source, engine: Engine::new(camera), next: 0 })
    }

    /// Returns the screen after frame `number`, which must not be before the last one; `None` if
    /// the clip has ended. `asked` is the number of cameras so far, for progress.
    pub(super) fn screen_after(
        &mut self,
        number: u64,
        asked: usize,
    ) -> Result<Option<FramePixels<'_>>, ExploreError> {
        while self.next <= number {
            self.footage.report_progress(ExploreProgress::RunningNetwork { cameras: asked })?;
            let Some(current) = self.source.next_frame()? else { return Ok(None) };
            let frames =
                FrameDepths::from_frame(&current.frame, [self.engine.camera().pixel_bits()])?;
            frames.step_engine(&mut self.engine, self.source.kind())?;
            self.source.recycle(current);
            self.next += 1;
        }
        Ok(Some(self.engine.rendered()))
    }
}
