// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core of any organization, clock by clock: what is applied to its inputs at an edge, and what drivers ask of it.

use foveate_design::PortRole;

use crate::Thresholds;

/// What is applied to the inputs of a core at one edge. A field whose port the core does not have means nothing.
#[derive(Clone, Copy, Debug)]
pub struct CoreInput<'a> {
    /// `rst_i`.
    pub reset: bool,
    /// `valid_i`.
    pub valid: bool,
    /// `sof_i`.
    pub sof: bool,
    /// `pixel_i`: one pixel per lane, or those of a word, the left one first.
    pub pixels: &'a [u16],
    /// `border_i` of a lone RPU: {bottom, top, right, left}, left in bit 0.
    pub border: u8,
    /// `reference_valid_i`.
    pub reference_valid: bool,
    /// `reference_pixel_i`: the pixels of a word, the left one first.
    pub reference_pixels: &'a [u16],
    /// `forward_ready_i`.
    pub forward_ready: bool,
    /// The threshold inputs.
    pub thresholds: &'a Thresholds,
}

impl<'a> CoreInput<'a> {
    /// Nothing is taken, whatever the pixel port shows; the sink is ready.
    #[must_use]
    pub fn idle(pixels: &'a [u16], thresholds: &'a Thresholds) -> Self {
        Self {
            reset: false,
            valid: false,
            sof: false,
            pixels,
            border: 0,
            reference_valid: false,
            reference_pixels: &[],
            forward_ready: true,
            thresholds,
        }
    }

    /// Pixels are offered; the sink is ready.
    #[must_use]
    pub fn valid(pixels: &'a [u16], thresholds: &'a Thresholds) -> Self {
        Self { valid: true, ..Self::idle(pixels, thresholds) }
    }
}

/// The cycle-level model of a core.
pub trait CycleModel {
    /// One rising edge.
    ///
    /// # Panics
    /// When there are not as many pixels as `pixel_i` has, or as `reference_pixel_i` where that is a port.
    fn clock(&mut self, input: &CoreInput<'_>);

    /// Appends what the output of a role shows after the last edge: the value of each lane, or each pixel of a word,
    /// the first lowest. Nothing where the core has no such output.
    fn show(&self, role: PortRole, values: &mut Vec<u64>);

    /// Whether something would be taken at the next edge.
    fn is_ready(&self) -> bool;

    /// How many clocks it takes, if nothing is offered, until something would be taken; a lower bound.
    fn clocks_until_ready(&self) -> u64 {
        u64::from(!self.is_ready())
    }

    /// For how many more clocks the outputs stay as they are, if nothing is offered; a lower bound.
    fn quiet_clocks(&self) -> u64 {
        0
    }

    /// [`CycleModel::quiet_clocks`] edges at once, without a reset and with nothing offered. None where there are none.
    fn skip_quiet_clocks(&mut self) {}

    /// Whether something of what was taken is still to come that needs no further frame.
    fn is_pending(&self) -> bool {
        false
    }

    /// Whether thresholds must stay as they are though no frame is under way: regions are still to be decided by them.
    fn holds_thresholds(&self) -> bool {
        false
    }

    /// Whether a region is lost in the middle at the next edge, unless that is a reset.
    fn aborts_next(&self) -> bool {
        false
    }

    /// What the next frame of a region will be compared with: scored pixels, row by row. `None` where there is no
    /// valid reference, and where the model does not know it before.
    fn reference(&self, region: u32) -> Option<&[u16]>;

    /// The means with which those of the next frame of a region will be compared, block by block. `None` where the screen shows
    /// no summary of it, and where the model does not know it before.
    fn summary(&self, region: u32) -> Option<&[u16]>;

    /// Whether the output of a role, which is one bit, shows a 1.
    fn is_high(&self, role: PortRole) -> bool {
        let mut values = Vec::new();
        self.show(role, &mut values);
        values.first() == Some(&1)
    }

    /// Another one in the same state.
    fn duplicate(&self) -> Box<dyn CycleModel>;
}
