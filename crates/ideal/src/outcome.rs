// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outcome of one frame.

use foveate_camera::RegionAction;

use crate::grid::RegionGrid;

/// The scores and decisions of every region, numbered row by row, and two whole frames. Every value
/// has its natural unit: no score is scaled to become an integer.
#[derive(Clone, Debug, PartialEq)]
pub struct IdealOutcome {
    /// The spatial relevance (SRS) of every region.
    pub srs: Vec<bool>,
    /// The temporal relevance (TRS) of every region.
    pub trs: Vec<bool>,
    /// The active regions, which have both SRS and TRS; their new pixels are sent.
    pub active: Vec<bool>,
    /// The action that the receiver's screen takes for every region.
    pub actions: Vec<RegionAction>,
    /// The scores by feature, in the order of the camera, and then by region: numbers of pixels for
    /// `edge`, `corner` and `segment`, grey levels for `mad`, `range`, `surface` and `flow`, squared
    /// grey levels for `variance`.
    pub scores: Vec<Vec<f64>>,
    /// The number of changed pixels of every region, 0..=n; n without a valid reference.
    pub changed: Vec<f64>,
    /// The denoised frame without padding: `width * height` grey levels, 0..=2^P - 1, in row-major
    /// order. They are whole numbers, or sixteenths of them with `binomial3x3`.
    pub denoised: Vec<f64>,
    /// The screen after this frame, in the same form as `denoised`.
    pub rendered: Vec<f64>,
}

impl IdealOutcome {
    pub(crate) fn new(features: usize, grid: &RegionGrid) -> Self {
        let (regions, pixels) = (grid.regions(), grid.width * grid.height);
        Self {
            srs: vec![false; regions],
            trs: vec![false; regions],
            active: vec![false; regions],
            actions: vec![RegionAction::Hold; regions],
            scores: vec![vec![0.0; regions]; features],
            changed: vec![0.0; regions],
            denoised: vec![0.0; pixels],
            rendered: vec![0.0; pixels],
        }
    }
}
