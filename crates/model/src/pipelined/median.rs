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

use super::delay_line::DelayLine;
use super::pixel::StagePixel;
use super::rpu_parameters::RpuParameters;
use super::window_stage::WindowStage;
use crate::window::PixelWindow;
use crate::window_filter::median;

/// The stage that takes raw pixels and gives denoised pixels, one per lane.
#[derive(Clone, Debug)]
pub(super) struct MedianStage {
    window: WindowStage,
    results: DelayLine<Vec<StagePixel>>,
}

impl MedianStage {
    pub(super) fn new(plan: &RpuParameters) -> Self {
        Self {
            window: WindowStage::new(plan, plan.stream_side),
            results: DelayLine::new(plan.median_registers),
        }
    }

    pub(super) fn reset(&mut self) {
        self.window.reset();
        self.results.reset();
    }

    /// Applies one edge, and returns the pixels that the next stage takes at this edge.
    pub(super) fn step(&mut self, pixels: Option<Vec<StagePixel>>) -> Option<Vec<StagePixel>> {
        // The raw halo of a shared region already repeats the border of the frame.
        let centers = self.window.step(pixels, None);
        let denoised = |center: StagePixel, window: &PixelWindow| StagePixel {
            scored: median(window),
            raw: center.raw,
        };
        self.results.step(centers.map(|centers| centers.map(denoised)))
    }
}
