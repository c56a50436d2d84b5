// SPDX-License-Identifier: MIT OR Apache-2.0
//! Several frames at once: the same results as one by one, handed to the threads once.

use foveate_camera::Camera;

use crate::core::{Core, Keep};
use crate::engine::{Engine, Lanes};
use crate::pixels::Pixels;
use crate::plan::index;
use crate::workers::Workers;
use crate::{EngineError, FrameOutcome, Screens, screens};
use foveate_lanes::Lane;

/// Bytes of frames that go through the engine together: what is compared first should still be in the
/// last-level cache when it is computed.
const TOGETHER: usize = 16 << 20;

impl Engine {
    /// Takes the next frames of a camera with up to 8 bits per pixel, the first one first; each is rows
    /// of bytes, `stride` apart, where they lie. Returns an outcome per frame, equal to those that
    /// [`Engine::step_u8`] gives one after the other; only which regions are skipped may differ.
    ///
    /// `screens`, where given, then has the rendered frame after each of them; the last is at
    /// [`Engine::rendered`] in any case. No frames at all change nothing.
    ///
    /// With one thread this is no faster than frame by frame; several share the work better, and also
    /// that of frames too small to be divided. Screens cost their writing: a few megabytes of frames per
    /// call keep all of it in the cache.
    ///
    /// # Errors
    /// When one of the frames is none of the camera; nothing has changed then, nor any screen.
    pub fn step_batch_u8(
        &mut self,
        frames: &[&[u8]],
        stride: usize,
        screens: Option<&mut Screens<u8>>,
    ) -> Result<&[FrameOutcome], EngineError> {
        let frames = checked(&self.camera, frames, stride)?;
        let Self { camera, workers, lanes, outcome, outcomes, .. } = self;
        match lanes {
            Lanes::Bytes(core) => {
                prepare(outcomes, camera, frames.len());
                run(core, workers, &frames, outcome, (outcomes, screens));
            }
            Lanes::Words(_) => return Err(self.wrong_lanes("u16", "u8")),
        }
        Ok(&self.outcomes[..frames.len()])
    }

    /// The same for cameras with 9 to 16 bits per pixel: frames, screens and `stride` in words.
    ///
    /// # Errors
    /// As [`Engine::step_batch_u8`].
    pub fn step_batch_u16(
        &mut self,
        frames: &[&[u16]],
        stride: usize,
        screens: Option<&mut Screens<u16>>,
    ) -> Result<&[FrameOutcome], EngineError> {
        let frames = checked(&self.camera, frames, stride)?;
        let Self { camera, workers, lanes, outcome, outcomes, .. } = self;
        match lanes {
            Lanes::Words(core) => {
                prepare(outcomes, camera, frames.len());
                run(core, workers, &frames, outcome, (outcomes, screens));
            }
            Lanes::Bytes(_) => return Err(self.wrong_lanes("u8", "u16")),
        }
        Ok(&self.outcomes[..frames.len()])
    }
}

/// The pixels as frames of the camera.
fn checked<'a, T: Lane>(
    camera: &Camera,
    frames: &[&'a [T]],
    stride: usize,
) -> Result<Vec<Pixels<'a, T>>, EngineError> {
    let frame = |(number, &values): (usize, &&'a [T])| {
        Pixels::checked(camera, values, stride)
            .map_err(|error| EngineError::InBatch { number, error: Box::new(error) })
    };
    frames.iter().enumerate().map(frame).collect()
}

/// Room for as many outcomes; those of longer batches stay for the next one.
fn prepare(outcomes: &mut Vec<FrameOutcome>, camera: &Camera, frames: usize) {
    let new = || FrameOutcome::new(camera.features().len(), index(camera.regions()));
    outcomes.resize_with(frames.max(outcomes.len()), new);
}

/// Takes the frames through the engine, as many at a time as the cache holds.
fn run<T: Lane>(
    core: &mut Core<T>,
    workers: &Workers,
    frames: &[Pixels<'_, T>],
    outcome: &mut FrameOutcome,
    (outcomes, screens): (&mut [FrameOutcome], Option<&mut Screens<T>>),
) {
    let room = |screens| screens::prepare(screens, &core.plan, frames.len());
    let screens = screens.map_or(&mut [][..], room);
    let Some(first) = frames.first() else { return };
    let bytes = first.width * first.height * size_of::<T>();
    let together = (TOGETHER / bytes).max(1);
    let mut screens = screens.chunks_mut(together);
    for (frames, outcomes) in frames.chunks(together).zip(outcomes.chunks_mut(together)) {
        let screens = screens.next().unwrap_or_default();
        let outcomes = &mut outcomes[..frames.len()];
        core.step(frames, workers, outcome, Keep { outcomes, screens });
    }
}
