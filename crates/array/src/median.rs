// SPDX-License-Identifier: MIT OR Apache-2.0
//! The median window of every RPU, with its two registers.
//!
//! A window that has stepped does not change any more, so its median is taken at once and waits in both
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
    /// The window register and the result register.
    registers: [Register<T>; 2],
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
            registers: [register(), register()],
        }
    }

    pub(crate) fn reset(&mut self) {
        self.window.reset();
        self.registers.iter_mut().for_each(|register| register.valid = false);
    }

    /// What the next stage takes at this edge, before [`MedianStage::step`].
    pub(crate) fn leaving(&self) -> Option<Pixels<'_, T>> {
        let [_, result] = &self.registers;
        let raw = result.raw.as_ref().map(|raw| raw.blocks());
        result.valid.then(|| Pixels { scored: result.scored.blocks(), raw })
    }

    /// One edge.
    #[inline(always)]
    pub(crate) fn step(&mut self, pixels: Option<Pixels<'_, T>>) {
        let Self { window, registers } = self;
        registers.swap(0, 1);
        let [stepped, _] = registers;
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
