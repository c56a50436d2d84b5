// SPDX-License-Identifier: MIT OR Apache-2.0
//! `range`: the largest minus the smallest pixel of the region, in grey levels.

use super::ScoreBuffers;
use crate::view::FrameView;

pub(super) fn score(view: &FrameView, scratch: &mut ScoreBuffers, scores: &mut [f64]) {
    let FrameView { grid, denoised: plane, .. } = *view;
    let [smallest, _] = &mut scratch.regions;
    smallest.clear();
    smallest.resize(grid.regions(), f64::INFINITY);
    scores.fill(f64::NEG_INFINITY);
    for y in 0..plane.height() {
        let regions = grid.regions_of_row(y);
        let extremes = smallest[regions.clone()].iter_mut().zip(&mut scores[regions]);
        for (part, (smallest, largest)) in plane.row(y).chunks_exact(grid.side).zip(extremes) {
            *smallest = part.iter().copied().fold(*smallest, f64::min);
            *largest = part.iter().copied().fold(*largest, f64::max);
        }
    }
    for (score, smallest) in scores.iter_mut().zip(smallest.iter()) {
        *score -= smallest;
    }
}
