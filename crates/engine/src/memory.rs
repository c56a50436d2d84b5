// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an engine knew before its last frame, copied while somebody asks for it: why that frame led to what it did can be
//! explained from this and the frame alone.

use foveate_camera::Reference;
use foveate_lanes::Lane;

use crate::plan::CameraPlan;

/// What was known of a region.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Before {
    /// The denoised pixels that it is compared with, row by row; none where there was no valid reference.
    pub reference: Option<Vec<u16>>,
    /// The means that the screen showed of it, block by block; none where it showed no summary.
    pub summary: Option<Vec<u16>>,
}

/// Copies of the planes between frames.
#[derive(Debug, Default)]
pub(crate) struct Memory<T> {
    reference: Vec<T>,
    valid: Vec<bool>,
    shown: Vec<bool>,
    means: Vec<T>,
    pub(crate) screen: Vec<T>,
}

/// The planes between frames, where they lie.
#[derive(Debug)]
pub(crate) struct Known<'a, T> {
    pub(crate) denoised: &'a [T],
    pub(crate) reference: &'a [T],
    pub(crate) valid: &'a [bool],
    pub(crate) shown: &'a [bool],
    pub(crate) means: &'a [T],
    pub(crate) screen: &'a [T],
}

impl<T: Lane> Memory<T> {
    /// Copies what is known now.
    pub(crate) fn take(&mut self, plan: &CameraPlan<T>, known: &Known<'_, T>) {
        let reference = match plan.reference {
            Reference::Previous => known.denoised,
            Reference::LastSent => known.reference,
        };
        copy(&mut self.reference, reference);
        copy(&mut self.valid, known.valid);
        copy(&mut self.shown, known.shown);
        copy(&mut self.means, known.means);
        copy(&mut self.screen, known.screen);
    }

    /// Whether anything was copied yet.
    pub(crate) fn is_taken(&self) -> bool {
        !self.valid.is_empty()
    }

    pub(crate) fn before(&self, plan: &CameraPlan<T>, region: u32) -> Before {
        let (at, mut before) = (region as usize, Before::default());
        if self.valid[at] {
            plan.pixels_of(&self.reference, region, before.reference.insert(Vec::new()));
        }
        // Without a periphery there are none.
        if self.shown.get(at) == Some(&true) {
            plan.means_of(&self.means, region, before.summary.insert(Vec::new()));
        }
        before
    }
}

fn copy<T: Copy>(to: &mut Vec<T>, from: &[T]) {
    to.clear();
    to.extend_from_slice(from);
}
