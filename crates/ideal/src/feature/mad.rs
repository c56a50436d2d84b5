// SPDX-License-Identifier: MIT OR Apache-2.0
//! `mad`: the mean absolute deviation from the region's real mean, in grey levels.
//!
//! With the sum S of the n pixels it is `sum |x - S/n| / n = sum |n x - S| / n^2`. Every value
//! before the division is a whole number below 2^53, so only the division rounds.

use super::{ScoreBuffers, pixel_sums, pixels_per_region};
use crate::view::FrameView;

pub(super) fn score(view: &FrameView, scratch: &mut ScoreBuffers, scores: &mut [f64]) {
    let FrameView { grid, denoised: plane, .. } = *view;
    let [sums, _] = &mut scratch.regions;
    pixel_sums(plane, grid, sums);
    let n = pixels_per_region(grid);
    scores.fill(0.0);
    for y in 0..plane.height() {
        let regions = scores[grid.regions_of_row(y)].iter_mut().zip(&sums[grid.regions_of_row(y)]);
        for (part, (score, sum)) in plane.row(y).chunks_exact(grid.side).zip(regions) {
            *score += part.iter().map(|x| (n * x - sum).abs()).sum::<f64>();
        }
    }
    for score in scores {
        *score /= n * n;
    }
}
