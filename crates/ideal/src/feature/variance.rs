// SPDX-License-Identifier: MIT OR Apache-2.0
//! `variance`: sigma^2 of the region, in squared grey levels.
//!
//! The variance is computed with shifted data (Chan, Golub, LeVeque, "Algorithms for Computing the
//! Sample Variance", 1983). With d = x - c for a whole number c near the mean,
//! `n^2 sigma^2 = n sum(d^2) - (sum d)^2`. Both terms are whole numbers below 2^53, so only the
//! division rounds. The only exception is a region of 64x64 pixels of 16 bits that spans the whole
//! range.

use super::{ScoreBuffers, pixel_sums, pixels_per_region};
use crate::view::FrameView;

pub(super) fn score(view: &FrameView, scratch: &mut ScoreBuffers, scores: &mut [f64]) {
    let FrameView { grid, denoised: plane, .. } = *view;
    let [sums, squares] = &mut scratch.regions;
    pixel_sums(plane, grid, sums);
    squares.clear();
    squares.resize(grid.regions(), 0.0);
    let n = pixels_per_region(grid);
    for (center, sum) in scores.iter_mut().zip(sums.iter()) {
        *center = (sum / n).round();
    }
    for y in 0..plane.height() {
        let regions =
            squares[grid.regions_of_row(y)].iter_mut().zip(&scores[grid.regions_of_row(y)]);
        for (part, (square, center)) in plane.row(y).chunks_exact(grid.side).zip(regions) {
            *square += part.iter().map(|x| (x - center) * (x - center)).sum::<f64>();
        }
    }
    for (score, (sum, square)) in scores.iter_mut().zip(sums.iter().zip(squares.iter())) {
        let rest = sum - n * *score;
        *score = (n * square - rest * rest) / (n * n);
    }
}
