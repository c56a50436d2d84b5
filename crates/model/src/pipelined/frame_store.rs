// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frame store of one region. It is never cleared. Flags outside of the store tell which
//! contents are valid.
//!
//! ```text
//! tail steps of frame        t            t+1          t+2
//! current (written)         x(t)         x(t+1)       x(t+2)
//! previous                  x(t-1)       x(t)         x(t+1)
//! older                     x(t-2)       x(t-1)       x(t)
//! rotated at the edge after done  ^            ^
//! ```

use super::pixel::StagePixel;
use super::rpu_parameters::RpuParameters;

/// The last frames of the region, and the frame that was sent last. The hardware stores fewer
/// frames, in banks that change roles instead of copies.
#[derive(Clone, Debug)]
pub(super) struct RegionFrameStore {
    current: Vec<StagePixel>,
    previous: Vec<StagePixel>,
    older: Vec<StagePixel>,
    sent: Vec<StagePixel>,
}

impl RegionFrameStore {
    pub(super) fn new(plan: &RpuParameters) -> Self {
        let frame = vec![StagePixel::default(); plan.pixels];
        Self { current: frame.clone(), previous: frame.clone(), older: frame.clone(), sent: frame }
    }

    pub(super) fn write(&mut self, position: usize, pixel: StagePixel) {
        self.current[position] = pixel;
    }

    /// Returns the scored value in the frame before the current one.
    pub(super) fn previous(&self, position: usize) -> u16 {
        self.previous[position].scored
    }

    /// Returns the scored value in the frame that was sent last.
    pub(super) fn sent(&self, position: usize) -> u16 {
        self.sent[position].scored
    }

    /// Returns a pixel of the frame that leaves, which is the last decided frame.
    pub(super) fn leaving_pixel(&self, plan: &RpuParameters, position: usize) -> StagePixel {
        if plan.second_pass { self.older[position] } else { self.previous[position] }
    }

    /// Makes the frame that has just been decided the one that was sent last. Must be called before
    /// [`RegionFrameStore::rotate`].
    pub(super) fn send_decided(&mut self, plan: &RpuParameters) {
        let decided = if plan.second_pass { &self.previous } else { &self.current };
        self.sent.clone_from(decided);
    }

    /// Ends the current frame, which becomes the previous one.
    pub(super) fn rotate(&mut self) {
        std::mem::swap(&mut self.older, &mut self.previous);
        std::mem::swap(&mut self.previous, &mut self.current);
    }
}
