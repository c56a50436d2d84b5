// SPDX-License-Identifier: MIT OR Apache-2.0
//! The public interface to the state before the last frame.

use foveate_pixels::{FramePixels, vectors::VectorPixel};

use crate::Engine;
use crate::engine::EngineCore;
use crate::state_copy::RegionStateBefore;
use crate::typed_engine::TypedEngine;

impl Engine {
    /// Turns the copy of the state before every frame on or off, from the next frame on. It costs a
    /// copy of two or three planes. [`Engine::region_state_before`] returns the state.
    pub fn set_state_copying(&mut self, on: bool) {
        match &mut self.core {
            EngineCore::Bytes(core) => core.set_state_copying(on),
            EngineCore::Words(core) => core.set_state_copying(on),
        }
    }

    /// Returns the state of a region before the last frame that was taken alone, not in a batch.
    /// Returns `None` if it was not copied.
    ///
    /// # Panics
    /// Panics if the camera has no such region.
    #[must_use]
    pub fn region_state_before(&self, region: u32) -> Option<RegionStateBefore> {
        fn of<T: VectorPixel>(core: &TypedEngine<T>, region: u32) -> Option<RegionStateBefore> {
            core.state_copy().map(|memory| memory.region_state(&core.plan, region))
        }
        match &self.core {
            EngineCore::Bytes(core) => of(core, region),
            EngineCore::Words(core) => of(core, region),
        }
    }

    /// Returns the screen before the last frame, or `None` if it was not copied.
    #[must_use]
    pub fn rendered_before(&self) -> Option<FramePixels<'_>> {
        match &self.core {
            EngineCore::Bytes(core) => {
                core.state_copy().map(|memory| FramePixels::Bytes(&memory.screen))
            }
            EngineCore::Words(core) => {
                core.state_copy().map(|memory| FramePixels::Words(&memory.screen))
            }
        }
    }
}
