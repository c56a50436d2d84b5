// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of the array.

use crate::Thresholds;

/// What is applied to the inputs of the array at one edge.
#[derive(Clone, Copy, Debug)]
pub struct SerialInput<'a> {
    /// `rst_i`.
    pub reset: bool,
    /// `valid_i`.
    pub valid: bool,
    /// `sof_i`; without meaning where the design does not find its frames.
    pub sof: bool,
    /// `pixel_i`: one pixel per lane, or one with `feed = "raster"`.
    pub pixels: &'a [u16],
    /// The threshold inputs; without meaning where the design has constants.
    pub thresholds: &'a Thresholds,
}

/// What the outputs of the array show after an edge. A port that means nothing shows 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SerialOutput {
    /// `ready_o`.
    pub ready: bool,
    /// `sync_error_o`.
    pub sync_error: bool,
    /// `score_valid_o`.
    pub score_valid: bool,
    /// `score_index_o`: 0 for the temporal count, 1.. for the features in the order of the design.
    pub score_index: u32,
    /// `region_o`.
    pub region: u32,
    /// `score_o`.
    pub score: u64,
    /// `decision_valid_o`.
    pub decision_valid: bool,
    /// `srs_o`.
    pub srs: bool,
    /// `trs_o`.
    pub trs: bool,
    /// `active_o`.
    pub active: bool,
    /// `forward_valid_o`: one per lane, or one with `feed = "raster"`.
    pub forward_valid: Vec<bool>,
    /// `forward_pixel_o`, likewise.
    pub forward_pixel: Vec<u16>,
    /// `forward_position_o`.
    pub forward_position: u32,
    /// `forward_slot_o`; 0 where the design has no such port.
    pub forward_slot: u32,
    /// `forward_region_o`; 0 where the design has no such port.
    pub forward_region: u32,
}

impl SerialOutput {
    /// Nothing is seen; `width` forwarded pixels at a time.
    pub(super) fn silent(width: usize) -> Self {
        Self { forward_valid: vec![false; width], forward_pixel: vec![0; width], ..Self::default() }
    }

    /// Forwards nothing any more.
    pub(super) fn stop_forwarding(&mut self) {
        self.forward_valid.fill(false);
        self.forward_pixel.fill(0);
    }

    /// Says nothing any more, but for the ports that may be as many as lanes.
    pub(super) fn stop_saying(&mut self) {
        let forward_valid = std::mem::take(&mut self.forward_valid);
        let forward_pixel = std::mem::take(&mut self.forward_pixel);
        *self = Self { forward_valid, forward_pixel, ..Self::default() };
    }
}
