// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frame store of one region. Nothing in it is ever cleared: who reads it knows from flags what
//! is valid.
//!
//! ```text
//! tail steps of frame        t            t+1          t+2
//! current (written)         x(t)         x(t+1)       x(t+2)
//! previous                  x(t-1)       x(t)         x(t+1)
//! older                     x(t-2)       x(t-1)       x(t)
//! rotated at the edge after done  ^            ^
//! ```

use super::pixel::Pixel;
use super::plan::RpuPlan;

/// The last frames of the region, and the one that was last sent. (Hardware keeps fewer: banks whose
/// roles change instead of copies.)
#[derive(Clone, Debug)]
pub(super) struct Store {
    current: Vec<Pixel>,
    previous: Vec<Pixel>,
    older: Vec<Pixel>,
    sent: Vec<Pixel>,
}

impl Store {
    pub(super) fn new(plan: &RpuPlan) -> Self {
        let frame = vec![Pixel::default(); plan.pixels];
        Self { current: frame.clone(), previous: frame.clone(), older: frame.clone(), sent: frame }
    }

    pub(super) fn write(&mut self, position: usize, pixel: Pixel) {
        self.current[position] = pixel;
    }

    /// The scored value in the frame before the one that is written.
    pub(super) fn previous(&self, position: usize) -> u16 {
        self.previous[position].scored
    }

    /// The scored value in the frame that was last sent.
    pub(super) fn sent(&self, position: usize) -> u16 {
        self.sent[position].scored
    }

    /// A pixel of the frame that leaves: the last one that has been decided.
    pub(super) fn leaving(&self, plan: &RpuPlan, position: usize) -> Pixel {
        if plan.second_pass { self.older[position] } else { self.previous[position] }
    }

    /// The frame that has just been decided becomes the one that was last sent. Comes before
    /// [`Store::rotate`].
    pub(super) fn send_decided(&mut self, plan: &RpuPlan) {
        let decided = if plan.second_pass { &self.previous } else { &self.current };
        self.sent.clone_from(decided);
    }

    /// The current frame is complete.
    pub(super) fn rotate(&mut self) {
        std::mem::swap(&mut self.older, &mut self.previous);
        std::mem::swap(&mut self.previous, &mut self.current);
    }
}
