// SPDX-License-Identifier: MIT OR Apache-2.0
//! The median window with its registers: two, or three in a deep RPU.
//!
//! ```text
//! edge                          e         e+1        e+2
//! window steps                  x
//! first register (after)        x          -          -
//! last register (after)         -        median       -
//! next stage takes                                  median
//! ```
//!
//! What is in the registers between cannot be seen, so the median is taken at once.

use super::line::Line;
use super::pixel::Pixel;
use super::plan::RpuPlan;
use super::window::WindowStage;
use crate::denoise::median;

/// Raw pixels in, denoised pixels out.
#[derive(Clone, Debug)]
pub(super) struct MedianStage {
    window: WindowStage,
    results: Line<Pixel>,
}

impl MedianStage {
    pub(super) fn new(plan: &RpuPlan) -> Self {
        Self {
            window: WindowStage::new(plan, plan.stream_side),
            results: Line::new(plan.median_registers),
        }
    }

    pub(super) fn reset(&mut self) {
        self.window.reset();
        self.results.reset();
    }

    /// One edge; returns what the next stage takes at this edge.
    pub(super) fn step(&mut self, pixel: Option<Pixel>) -> Option<Pixel> {
        // The raw halo of a shared region repeats the frame's border already.
        let no_border = 0;
        let center = self.window.step(pixel, no_border);
        let result =
            center.map(|center| Pixel { scored: median(&center.window), raw: center.pixel.raw });
        self.results.step(result)
    }
}
