// SPDX-License-Identifier: MIT OR Apache-2.0
//! The public interface to the state before the last frame.

use foveate_frame::Plane;
use foveate_lanes::Lane;

use crate::Engine;
use crate::core::Core;
use crate::engine::Lanes;
use crate::memory::Before;

impl Engine {
    /// Turns the copy of the state before every frame on or off, from the next frame on. It costs a
    /// copy of two or three planes. [`Engine::before`] returns the state.
    pub fn remember(&mut self, on: bool) {
        match &mut self.lanes {
            Lanes::Bytes(core) => core.remember(on),
            Lanes::Words(core) => core.remember(on),
        }
    }

    /// Returns the state of a region before the last frame that was taken alone, not in a batch.
    /// Returns `None` if it was not copied.
    ///
    /// # Panics
    /// Panics if the camera has no such region.
    #[must_use]
    pub fn before(&self, region: u32) -> Option<Before> {
        fn of<T: Lane>(core: &Core<T>, region: u32) -> Option<Before> {
            core.memory().map(|memory| memory.before(&core.plan, region))
        }
        match &self.lanes {
            Lanes::Bytes(core) => of(core, region),
            Lanes::Words(core) => of(core, region),
        }
    }

    /// Returns the screen before the last frame, or `None` if it was not copied.
    #[must_use]
    pub fn rendered_before(&self) -> Option<Plane<'_>> {
        match &self.lanes {
            Lanes::Bytes(core) => core.memory().map(|memory| Plane::Bytes(&memory.screen)),
            Lanes::Words(core) => core.memory().map(|memory| Plane::Words(&memory.screen)),
        }
    }
}
