// SPDX-License-Identifier: MIT OR Apache-2.0
//! The median window of every RPU, with its registers.
//!
//! A window that has stepped does not change any more, so its median is taken at once and waits in all
//! registers, where the hardware takes it between them.

use foveate_lanes::Lane;

use crate::kernel;
use crate::plan::Plan;
use crate::rows::{Row, row};
use crate::window::{Pixels, WindowStage};

/// Raw pixels in, denoised pixels out.
#[derive(Clone, Debug)]
pub(crate) struct MedianStage<T: Lane> {
    window: WindowStage<T>,
    /// The newest first.
    registers: Vec<Register<T>>,
}

#[derive(Clone, Debug)]
struct Register<T: Lane> {
    valid: bool,
    scored: Row<T>,
    raw: Option<Row<T>>,
}

impl<T: Lane> MedianStage<T> {
    pub(crate) fn new(plan: &Plan) -> Self {
        let register = || Register {
            valid: false,
            scored: row(plan.lanes),
            raw: plan.keeps_raw.then(|| row(plan.lanes)),
        };
        Self {
            window: WindowStage::new(plan, plan.stream_side, false, None),
            registers: (0..plan.median_registers).map(|_| register()).collect(),
        }
    }

    pub(crate) fn reset(&mut self) {
        self.window.reset();
        self.registers.iter_mut().for_each(|register| register.valid = false);
    }

    /// What the next stage takes at this edge, before [`MedianStage::step`].
    pub(crate) fn leaving(&self) -> Option<Pixels<'_, T>> {
        let result = self.registers.last().expect("a median has registers");
        let raw = result.raw.as_ref().map(|raw| raw.blocks());
        result.valid.then(|| Pixels { scored: result.scored.blocks(), raw })
    }

    /// One edge.
    #[inline(always)]
    pub(crate) fn step(&mut self, pixels: Option<Pixels<'_, T>>) {
        let Self { window, registers } = self;
        registers.rotate_right(1);
        let stepped = &mut registers[0];
        let center = window.step(pixels);
        stepped.valid = center.is_some();
        if let Some(center) = center {
            if let Some(raw) = &mut stepped.raw {
                raw.blocks_mut().copy_from_slice(window.pixels(center).scored);
            }
            kernel::median(window.window(center), stepped.scored.blocks_mut());
        }
    }
}
