// SPDX-License-Identifier: MIT OR Apache-2.0
//! The memory of an engine as its callers see it.

use foveate_frame::Plane;
use foveate_lanes::Lane;

use crate::Engine;
use crate::core::Core;
use crate::engine::Lanes;
use crate::memory::Before;

impl Engine {
    /// Whether to copy what is known before every frame from the next one on, which costs a copy of two or three planes;
    /// [`Engine::before`] tells it.
    pub fn remember(&mut self, on: bool) {
        match &mut self.lanes {
            Lanes::Bytes(core) => core.remember(on),
            Lanes::Words(core) => core.remember(on),
        }
    }

    /// What was known of a region before the last frame that came alone (not in a batch); nothing where it was not
    /// remembered.
    ///
    /// # Panics
    /// When the camera has no such region.
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

    /// What was on the screen then.
    #[must_use]
    pub fn rendered_before(&self) -> Option<Plane<'_>> {
        match &self.lanes {
            Lanes::Bytes(core) => core.memory().map(|memory| Plane::Bytes(&memory.screen)),
            Lanes::Words(core) => core.memory().map(|memory| Plane::Words(&memory.screen)),
        }
    }
}
