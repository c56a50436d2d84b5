// SPDX-License-Identifier: MIT OR Apache-2.0
//! The median window with its two registers.
//!
//! ```text
//! edge                          e         e+1        e+2
//! window steps                  x
//! window register (after)       x          -          -
//! result register (after)       -        median       -
//! next stage takes                                  median
//! ```

use super::center::Center;
use super::pixel::Pixel;
use super::plan::Plan;
use super::window::WindowStage;
use crate::denoise::median;

/// Raw pixels in, denoised pixels out.
#[derive(Clone, Debug)]
pub(super) struct MedianStage {
    window: WindowStage,
    stepped: Option<Center>,
    result: Option<Pixel>,
}

impl MedianStage {
    pub(super) fn new(plan: &Plan) -> Self {
        Self { window: WindowStage::new(plan, plan.stream_side), stepped: None, result: None }
    }

    pub(super) fn reset(&mut self) {
        self.window.reset();
        self.stepped = None;
        self.result = None;
    }

    /// One edge; returns what the next stage takes at this edge.
    pub(super) fn step(&mut self, pixel: Option<Pixel>) -> Option<Pixel> {
        let leaving = self.result;
        self.result = self
            .stepped
            .map(|center| Pixel { scored: median(&center.window), raw: center.pixel.raw });
        // The raw halo of a shared region repeats the frame's border already.
        let no_border = 0;
        self.stepped = self.window.step(pixel, no_border);
        leaving
    }
}
