// SPDX-License-Identifier: MIT OR Apache-2.0
//! The interface of the cycle-level models of all organizations ([`CycleModel`]): the inputs at
//! a clock edge ([`CoreInput`]), and the questions that test drivers ask. What a region gets at
//! a port is the same for all of them: its pixels with their halo ([`region_stream`]), and the
//! sides of it that are sides of the frame ([`region_border`]).

use crate::region::RegionArea;
use crate::{ClassMapInputs, ThresholdInputs, ZoneInputs};
use foveate_camera::Camera;
use foveate_design::PortRole;
use foveate_pixels::Frame;

/// The inputs of a core at one clock edge. A field whose port the core does not have is ignored.
#[derive(Clone, Copy, Debug)]
pub struct CoreInput<'a> {
    /// Value of `rst_i`.
    pub reset: bool,
    /// Value of `valid_i`.
    pub valid: bool,
    /// Value of `sof_i`.
    pub sof: bool,
    /// Value of `pixel_i`: one pixel per lane, or the pixels of a word, the left one first.
    pub pixels: &'a [u16],
    /// Value of `border_i` of a lone RPU: {bottom, top, right, left}, left in bit 0.
    pub border: u8,
    /// Value of `reference_valid_i`.
    pub reference_valid: bool,
    /// Value of `reference_pixel_i`: the pixels of a word, the left one first.
    pub reference_pixels: &'a [u16],
    /// Value of `forward_ready_i`.
    pub forward_ready: bool,
    /// Values of the threshold inputs.
    pub thresholds: &'a ThresholdInputs,
    /// Values of the inputs that only a core with zones has. Without them all classes have the same
    /// thresholds, and nothing is written to the memory of classes. Every region of a pipelined
    /// core is then [`foveate_camera::RegionClass::Normal`].
    pub zones: Option<ZoneInputs<'a>>,
}

impl<'a> CoreInput<'a> {
    /// Makes an input without a valid pixel, whatever the pixel port shows. The sink is ready.
    #[must_use]
    pub fn idle(pixels: &'a [u16], thresholds: &'a ThresholdInputs) -> Self {
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
            zones: None,
        }
    }

    /// Makes an input with valid pixels. The sink is ready.
    #[must_use]
    pub fn valid(pixels: &'a [u16], thresholds: &'a ThresholdInputs) -> Self {
        Self { valid: true, ..Self::idle(pixels, thresholds) }
    }

    /// Returns the inputs of the memory of classes. Without zones nothing is written.
    #[must_use]
    pub fn class_map(&self) -> ClassMapInputs {
        self.zones.map(|zones| zones.map).unwrap_or_default()
    }
}

/// The cycle-level model of a core.
pub trait CycleModel {
    /// Applies one rising clock edge.
    ///
    /// # Panics
    /// Panics if there are not as many pixels as `pixel_i` has, or as `reference_pixel_i` has in a
    /// core with that port.
    fn clock(&mut self, input: &CoreInput<'_>);

    /// Appends the values of the output of a role after the last edge: one value per lane, or one
    /// per pixel of a word, the lowest first. Appends nothing if the core has no such output.
    fn append_output(&self, role: PortRole, values: &mut Vec<u64>);

    /// Returns true if the core would take a valid input at the next edge.
    fn is_ready(&self) -> bool;

    /// Returns a lower bound of the clocks without valid inputs until the core would take one.
    fn clocks_until_ready(&self) -> u64 {
        u64::from(!self.is_ready())
    }

    /// Returns a lower bound of the clocks without valid inputs, and without a write or commit to
    /// the memory of classes, for which the outputs stay as they are.
    fn quiet_clocks(&self) -> u64 {
        0
    }

    /// Applies [`CycleModel::quiet_clocks`] edges at once, without a reset, without valid inputs,
    /// and without a write or commit to the memory of classes. There may be none.
    fn skip_quiet_clocks(&mut self) {}

    /// Returns true if outputs of pixels that were taken are still to come without another frame.
    fn is_pending(&self) -> bool {
        false
    }

    /// Returns true if thresholds must stay constant although no frame is under way, because
    /// regions are still to be decided with them.
    fn requires_stable_thresholds(&self) -> bool {
        false
    }

    /// Returns true if a region is lost in the middle at the next edge, unless that edge has a
    /// reset.
    fn will_abort(&self) -> bool {
        false
    }

    /// Returns the reference of a region for the next frame: scored pixels in row-major order.
    /// Returns `None` if there is no valid reference, or if the model does not know it in advance.
    fn reference(&self, region: u32) -> Option<&[u16]>;

    /// Returns the means, block by block, that those of the next frame of a region will be compared
    /// with. Returns `None` if the screen shows no summary of the region, or if the model does not
    /// know it in advance.
    fn summary(&self, region: u32) -> Option<&[u16]>;

    /// Returns true if the one-bit output of a role is 1.
    fn is_high(&self, role: PortRole) -> bool {
        let mut values = Vec::new();
        self.append_output(role, &mut values);
        values.first() == Some(&1)
    }

    /// Returns a copy of the model in the same state.
    fn duplicate(&self) -> Box<dyn CycleModel>;
}

/// Appends the raw pixels that region `region` of a frame sends to its RPU: a square of side
/// `camera.stream_side()` in row-major order. A position outside of the frame holds the nearest
/// pixel, both for padding and for the halo. A padded frame gives the same stream.
pub fn region_stream(camera: &Camera, frame: &Frame, region: u32, out: &mut Vec<u16>) {
    let area = RegionArea::from_region(camera, region);
    let halo = i64::from(camera.halo());
    let reach = |from: u32| i64::from(from) - halo..i64::from(from + area.side) + halo;
    for y in reach(area.top) {
        out.extend(reach(area.left).map(|x| frame.get_clamped(x, y)));
    }
}

/// Bit of [`region_border`] for a left side that is the left side of the frame.
pub(crate) const LEFT: u8 = 0b0001;
/// Bit of [`region_border`] for a right side that is the right side of the frame.
pub(crate) const RIGHT: u8 = 0b0010;
/// Bit of [`region_border`] for an upper side that is the upper side of the frame.
pub(crate) const TOP: u8 = 0b0100;
/// Bit of [`region_border`] for a lower side that is the lower side of the frame.
pub(crate) const BOTTOM: u8 = 0b1000;

/// Returns the sides of a region that are sides of the padded frame, as `border_i` takes them:
/// `{bottom, top, right, left}`, left in bit 0.
#[must_use]
pub fn region_border(camera: &Camera, region: u32) -> u8 {
    let (column, row) = (region % camera.columns(), region / camera.columns());
    [
        (column == 0, LEFT),
        (column + 1 == camera.columns(), RIGHT),
        (row == 0, TOP),
        (row + 1 == camera.rows(), BOTTOM),
    ]
    .into_iter()
    .filter_map(|(touches, bit)| touches.then_some(bit))
    .sum()
}
