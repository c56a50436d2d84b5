// SPDX-License-Identifier: MIT OR Apache-2.0
//! `segment`: the smaller one of the numbers of pixels that lie more than a level above, and below,
//! the region's real mean.
//!
//! With the sum S of the n pixels, a pixel is above if `n x > S + n level`. All values are whole
//! numbers, or sixteenths of them, below 2^53, so nothing rounds.

use super::{ScoreBuffers, pixel_sums, pixels_per_region};
use crate::view::FrameView;

pub(super) fn score(level: f64, view: &FrameView, scratch: &mut ScoreBuffers, scores: &mut [f64]) {
    let FrameView { grid, denoised: plane, .. } = *view;
    let [sums, counts_below] = &mut scratch.regions;
    pixel_sums(plane, grid, sums);
    counts_below.clear();
    counts_below.resize(grid.regions(), 0.0);
    scores.fill(0.0);
    let n = pixels_per_region(grid);
    for y in 0..plane.height() {
        let regions = grid.regions_of_row(y);
        let counts = scores[regions.clone()].iter_mut().zip(&mut counts_below[regions.clone()]);
        let counts = counts.zip(&sums[regions]);
        for (part, ((above, below), sum)) in plane.row(y).chunks_exact(grid.side).zip(counts) {
            for x in part {
                let deviation = n * x - sum;
                *above += if deviation > n * level { 1.0 } else { 0.0 };
                *below += if deviation < -n * level { 1.0 } else { 0.0 };
            }
        }
    }
    for (score, below) in scores.iter_mut().zip(counts_below.iter()) {
        *score = score.min(*below);
    }
}
