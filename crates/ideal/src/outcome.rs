// SPDX-License-Identifier: MIT OR Apache-2.0
//! What one frame leads to.

use foveate_camera::Action;

use crate::grid::Grid;

/// Scores and decisions of every region, numbered row by row, and two whole frames. In the natural unit
/// each: no score is scaled to become an integer.
#[derive(Clone, Debug, PartialEq)]
pub struct IdealOutcome {
    /// Spatial relevance of every region.
    pub srs: Vec<bool>,
    /// Temporal relevance of every region.
    pub trs: Vec<bool>,
    /// Both: new pixels of the region are forwarded.
    pub active: Vec<bool>,
    /// What becomes of every region on the screen.
    pub actions: Vec<Action>,
    /// Scores, by feature in the order of the camera and then by region: hits 0..=n for `edge` and
    /// `corner`, grey levels for `mad`, squared grey levels for `variance`.
    pub scores: Vec<Vec<f64>>,
    /// Changed pixels of every region, 0..=n; all of them where there was no valid reference.
    pub changed: Vec<f64>,
    /// The denoised frame without padding, row by row, `width * height` whole grey levels, 0..=2^P - 1.
    pub denoised: Vec<f64>,
    /// What is on the screen after this frame, in the same form.
    pub rendered: Vec<f64>,
}

impl IdealOutcome {
    pub(crate) fn new(features: usize, grid: &Grid) -> Self {
        let (regions, pixels) = (grid.regions(), grid.width * grid.height);
        Self {
            srs: vec![false; regions],
            trs: vec![false; regions],
            active: vec![false; regions],
            actions: vec![Action::Hold; regions],
            scores: vec![vec![0.0; regions]; features],
            changed: vec![0.0; regions],
            denoised: vec![0.0; pixels],
            rendered: vec![0.0; pixels],
        }
    }
}
