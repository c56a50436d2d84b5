// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ports of one RPU: what is applied at an edge, and what is shown after it.

use super::plan::FEATURES;

/// What is applied to the inputs of an RPU at one edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RpuInput {
    /// `rst_i`.
    pub reset: bool,
    /// `valid_i`.
    pub valid: bool,
    /// `pixel_i`.
    pub pixel: u16,
    /// `border_i`: {bottom, top, right, left}, left in bit 0; without meaning where the design
    /// has no such port.
    pub border: u8,
}

/// What the outputs of an RPU show after an edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RpuOutput {
    /// `decision_valid_o`.
    pub decision_valid: bool,
    /// `srs_o`.
    pub srs: bool,
    /// `trs_o`.
    pub trs: bool,
    /// `active_o`.
    pub active: bool,
    /// The score ports, by number of the feature in the design; 0 where there is none.
    pub scores: [u64; FEATURES],
    /// `temporal_count_o`.
    pub temporal_count: u32,
    /// `summary_o`.
    pub summary: bool,
    /// `forward_valid_o`.
    pub forward_valid: bool,
    /// `forward_pixel_o`.
    pub forward_pixel: u16,
}
