// SPDX-License-Identifier: MIT OR Apache-2.0
//! The filter window with its registers: two of them, or three in a deep RPU.
//!
//! ```text
//! edge                          e         e+1        e+2
//! window steps                  x
//! first register (after)        x          -          -
//! last register (after)         -       denoised      -
//! next stage takes                                 denoised
//! ```
//!
//! The values between the registers cannot be observed, so the model computes the filter at once.

use foveate_camera::DenoiseFilter;

use super::delay_line::DelayLine;
use super::pixel::StagePixel;
use super::rpu_parameters::RpuParameters;
use super::window_stage::WindowStage;
use crate::window::PixelWindow;
use crate::window_filter::filtered_pixel;

/// The stage that takes raw pixels and gives denoised pixels, one per lane.
#[derive(Clone, Debug)]
pub(super) struct FilterStage {
    filter: DenoiseFilter,
    window: WindowStage,
    results: DelayLine<Vec<StagePixel>>,
}

impl FilterStage {
    pub(super) fn new(plan: &RpuParameters) -> Self {
        Self {
            filter: plan.filter,
            window: WindowStage::new(plan, plan.stream_side),
            results: DelayLine::new(plan.filter_registers),
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
        let filter = self.filter;
        let denoised = |center: StagePixel, window: &PixelWindow| StagePixel {
            scored: filtered_pixel(filter, window),
            raw: center.raw,
        };
        self.results.step(centers.map(|centers| centers.map(denoised)))
    }
}
