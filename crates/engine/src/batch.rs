// SPDX-License-Identifier: MIT OR Apache-2.0
//! Several frames in one call: the results are those of single frames, but threads get their work
//! only once.

use foveate_camera::Camera;

use super::receiver;
use crate::engine::{Engine, EngineCore};
use crate::pixels::BorrowedFrame;
use crate::plan::index;
use crate::typed_engine::{KeptBuffers, TypedEngine};
use crate::workers::Workers;
use crate::{BatchScreens, EngineError, FrameOutcome};
use foveate_pixels::vectors::VectorPixel;

/// The number of bytes of the frames of a group, which goes through the engine together. A group is
/// small enough that its pixels are still in the last-level cache when they are scored, after all
/// of them were compared.
const GROUP_BYTES: usize = 16 << 20;

impl Engine {
    /// Takes the next frames of a camera with up to 8 bits per pixel, in order and without copying
    /// them. The rows of each frame start `stride` bytes apart. Returns one outcome per frame,
    /// equal to the outcomes of single calls of [`Engine::step_u8`]; only the number of skipped
    /// regions may differ.
    ///
    /// If `screens` is given, it then has the rendered frame after each of the frames.
    /// [`Engine::rendered`] has the last one in any case. A call without frames changes nothing.
    ///
    /// With one thread this is no faster than single calls. Several threads share the work better,
    /// and also share frames that are too small to be divided. Screens cost the time to write them;
    /// with a few megabytes of frames per call they stay in the cache.
    ///
    /// # Errors
    /// Fails if one of the frames is not a frame of the camera. State and screens are unchanged
    /// then.
    pub fn step_batch_u8(
        &mut self,
        frames: &[&[u8]],
        stride: usize,
        screens: Option<&mut BatchScreens<u8>>,
    ) -> Result<&[FrameOutcome], EngineError> {
        let frames = check_frames(&self.camera, frames, stride)?;
        let Self { camera, workers, core, outcome, batch_outcomes: outcomes, .. } = self;
        match core {
            EngineCore::Bytes(core) => {
                resize_outcomes(outcomes, camera, frames.len());
                step_groups(core, workers, &frames, outcome, (outcomes, screens));
            }
            EngineCore::Words(_) => return Err(self.wrong_pixel_type("u16", "u8")),
        }
        Ok(&self.batch_outcomes[..frames.len()])
    }

    /// Takes the next frames of a camera with 9 to 16 bits per pixel, as [`Engine::step_batch_u8`]
    /// does. Frames, screens and `stride` are in words.
    ///
    /// # Errors
    /// The errors are those of [`Engine::step_batch_u8`].
    pub fn step_batch_u16(
        &mut self,
        frames: &[&[u16]],
        stride: usize,
        screens: Option<&mut BatchScreens<u16>>,
    ) -> Result<&[FrameOutcome], EngineError> {
        let frames = check_frames(&self.camera, frames, stride)?;
        let Self { camera, workers, core, outcome, batch_outcomes: outcomes, .. } = self;
        match core {
            EngineCore::Words(core) => {
                resize_outcomes(outcomes, camera, frames.len());
                step_groups(core, workers, &frames, outcome, (outcomes, screens));
            }
            EngineCore::Bytes(_) => return Err(self.wrong_pixel_type("u8", "u16")),
        }
        Ok(&self.batch_outcomes[..frames.len()])
    }
}

fn check_frames<'a, T: VectorPixel>(
    camera: &Camera,
    frames: &[&'a [T]],
    stride: usize,
) -> Result<Vec<BorrowedFrame<'a, T>>, EngineError> {
    let frame = |(number, &values): (usize, &&'a [T])| {
        BorrowedFrame::new_checked(camera, values, stride)
            .map_err(|error| EngineError::BatchFrame { number, error: Box::new(error) })
    };
    frames.iter().enumerate().map(frame).collect()
}

/// Makes room for one outcome per frame. The outcomes of longer batches stay for the next one.
fn resize_outcomes(outcomes: &mut Vec<FrameOutcome>, camera: &Camera, frames: usize) {
    let new = || FrameOutcome::new(camera, index(camera.regions()));
    outcomes.resize_with(frames.max(outcomes.len()), new);
}

/// Takes the frames through the engine, as many at a time as fit into the cache.
fn step_groups<T: VectorPixel>(
    core: &mut TypedEngine<T>,
    workers: &Workers,
    frames: &[BorrowedFrame<'_, T>],
    outcome: &mut FrameOutcome,
    (outcomes, screens): (&mut [FrameOutcome], Option<&mut BatchScreens<T>>),
) {
    let room = |screens| receiver::resize_screens(screens, &core.plan, frames.len());
    let screens = screens.map_or(&mut [][..], room);
    let Some(first) = frames.first() else { return };
    let bytes = first.width * first.height * size_of::<T>();
    let together = (GROUP_BYTES / bytes).max(1);
    let mut screens = screens.chunks_mut(together);
    for (frames, outcomes) in frames.chunks(together).zip(outcomes.chunks_mut(together)) {
        let screens = screens.next().unwrap_or_default();
        let outcomes = &mut outcomes[..frames.len()];
        core.step(frames, workers, outcome, KeptBuffers { outcomes, screens });
    }
}
