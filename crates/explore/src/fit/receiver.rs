// SPDX-License-Identifier: MIT OR Apache-2.0
//! The receiver of a camera over a clip.

use foveate_camera::Camera;
use foveate_engine::Engine;
use foveate_footage::Source;
use foveate_frame::Plane;

use crate::depths::Depths;
use crate::footage::Footage;
use crate::{ExploreError, Progress};

/// A camera that sees a clip, and its receiver.
pub(super) struct Receiver<'a> {
    footage: &'a Footage<'a>,
    source: Box<dyn Source>,
    engine: Engine,
    /// The number of the next frame.
    next: u64,
}

impl<'a> Receiver<'a> {
    pub(super) fn new(
        footage: &'a Footage<'a>,
        clip: usize,
        camera: &Camera,
    ) -> Result<Self, ExploreError> {
        let source = footage.open(&footage.subjects[clip])?;
        Ok(Self { footage, source, engine: Engine::new(camera), next: 0 })
    }

    /// Returns the screen after frame `number`, which must not be before the last one; `None` if
    /// the clip has ended. `asked` is the number of cameras so far, for progress.
    pub(super) fn screen(
        &mut self,
        number: u64,
        asked: usize,
    ) -> Result<Option<Plane<'_>>, ExploreError> {
        while self.next <= number {
            self.footage.go_on(Progress::Asking { cameras: asked })?;
            let Some(current) = self.source.next_frame()? else { return Ok(None) };
            let frames = Depths::of(&current.frame, [self.engine.camera().pixel_bits()])?;
            frames.show(&mut self.engine, self.source.kind())?;
            self.source.give_back(current);
            self.next += 1;
        }
        Ok(Some(self.engine.rendered()))
    }
}
