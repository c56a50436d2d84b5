// SPDX-License-Identifier: MIT OR Apache-2.0
//! Copies of the state that an engine had before its last frame. Together with the frame they
//! explain its outcome. They are made only if the caller asks for them.

use foveate_camera::ReferencePolicy;
use foveate_pixels::vectors::VectorPixel;

use crate::plan::CameraPlan;

/// The state of one region before a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RegionStateBefore {
    /// The reference of the region, N x N denoised pixels in row-major order, or `None` if it was
    /// not valid.
    pub reference: Option<Vec<u16>>,
    /// The means that the screen showed for the region, block by block, or `None` if it showed no
    /// summary.
    pub summary: Option<Vec<u16>>,
}

/// Copies of the planes that are kept between frames.
#[derive(Debug, Default)]
pub(crate) struct StateCopy<T> {
    reference: Vec<T>,
    reference_valid: Vec<bool>,
    summary_shown: Vec<bool>,
    means: Vec<T>,
    pub(crate) screen: Vec<T>,
}

/// The planes that are kept between frames, borrowed from the engine.
#[derive(Debug)]
pub(crate) struct EngineState<'a, T> {
    pub(crate) denoised: &'a [T],
    pub(crate) reference: &'a [T],
    pub(crate) valid: &'a [bool],
    pub(crate) shown: &'a [bool],
    pub(crate) means: &'a [T],
    pub(crate) screen: &'a [T],
}

impl<T: VectorPixel> StateCopy<T> {
    pub(crate) fn copy_from(&mut self, plan: &CameraPlan<T>, known: &EngineState<'_, T>) {
        let reference = match plan.reference {
            ReferencePolicy::Previous => known.denoised,
            ReferencePolicy::LastSent => known.reference,
        };
        copy(&mut self.reference, reference);
        copy(&mut self.reference_valid, known.valid);
        copy(&mut self.summary_shown, known.shown);
        copy(&mut self.means, known.means);
        copy(&mut self.screen, known.screen);
    }

    /// Returns true if a state was copied.
    pub(crate) fn has_state(&self) -> bool {
        !self.reference_valid.is_empty()
    }

    pub(crate) fn region_state(&self, plan: &CameraPlan<T>, region: u32) -> RegionStateBefore {
        let (at, mut before) = (region as usize, RegionStateBefore::default());
        if self.reference_valid[at] {
            plan.pixels_of(&self.reference, region, before.reference.insert(Vec::new()));
        }
        // A camera without a periphery has no summaries.
        if self.summary_shown.get(at) == Some(&true) {
            plan.means_of(&self.means, region, before.summary.insert(Vec::new()));
        }
        before
    }
}

fn copy<T: Copy>(to: &mut Vec<T>, from: &[T]) {
    to.clear();
    to.extend_from_slice(from);
}
