// SPDX-License-Identifier: MIT OR Apache-2.0
//! The median window with its registers: two of them, or three in a deep RPU.
//!
//! ```text
//! edge                          e         e+1        e+2
//! window steps                  x
//! first register (after)        x          -          -
//! last register (after)         -        median       -
//! next stage takes                                  median
//! ```
//!
//! The values between the registers cannot be observed, so the model computes the median at once.

use super::line::Line;
use super::pixel::Pixel;
use super::plan::RpuPlan;
use super::window::WindowStage;
use crate::denoise::median;

/// The stage that takes raw pixels and gives denoised pixels.
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

    /// Applies one edge, and returns the pixel that the next stage takes at this edge.
    pub(super) fn step(&mut self, pixel: Option<Pixel>) -> Option<Pixel> {
        // The raw halo of a shared region already repeats the border of the frame.
        let no_border = 0;
        let center = self.window.step(pixel, no_border);
        let result =
            center.map(|center| Pixel { scored: median(&center.window), raw: center.pixel.raw });
        self.results.step(result)
    }
}
