// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of one RPU: the inputs at an edge, and the outputs after it.

use super::rpu_parameters::MAX_FEATURES;

/// The inputs of an RPU at one edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RpuInput {
    /// Value of `rst_i`.
    pub reset: bool,
    /// Value of `valid_i`.
    pub valid: bool,
    /// Value of `pixel_i`.
    pub pixel: u16,
    /// Value of `border_i`: {bottom, top, right, left}, left in bit 0. It is ignored if the design
    /// has no such port.
    pub border: u8,
}

/// The outputs of an RPU after an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RpuOutput {
    /// Value of `decision_valid_o`.
    pub decision_valid: bool,
    /// Value of `srs_o`.
    pub srs: bool,
    /// Value of `trs_o`.
    pub trs: bool,
    /// Value of `active_o`.
    pub active: bool,
    /// Values of the score ports, by number of the feature in the design. They are 0 for numbers
    /// without a feature.
    pub scores: [u64; MAX_FEATURES],
    /// Value of `temporal_count_o`.
    pub temporal_count: u32,
    /// Value of `summary_o`.
    pub summary: bool,
    /// Value of `forward_valid_o`.
    pub forward_valid: bool,
    /// Value of `forward_pixel_o`.
    pub forward_pixel: u16,
}
