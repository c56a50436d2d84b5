// SPDX-License-Identifier: MIT OR Apache-2.0
//! `surface`: the smallest mean absolute difference between the region and itself, moved by one
//! pixel in one of four directions, in grey levels.

use super::{ScoreBuffers, add_row_to_sums, pixels_per_region};
use crate::view::FrameView;

/// The displacements, as columns to the right and rows down.
const DISPLACEMENTS: [(isize, usize); 4] = [(1, 0), (0, 1), (1, 1), (-1, 1)];

pub(super) fn score(view: &FrameView, scratch: &mut ScoreBuffers, scores: &mut [f64]) {
    let FrameView { grid, denoised: plane, .. } = *view;
    let ([differences, ..], [sums, _]) = (&mut scratch.lines, &mut scratch.regions);
    differences.resize(plane.width(), 0.0);
    scores.fill(f64::INFINITY);
    for (right, down) in DISPLACEMENTS {
        sums.clear();
        sums.resize(grid.regions(), 0.0);
        for y in 0..plane.height() {
            let [_, here, below] = plane.window_lines(y);
            // A line begins with the pixel beyond the left border.
            let moved = &[here, below][down][1_usize.saturating_add_signed(right)..];
            for (difference, (x, other)) in differences.iter_mut().zip(here[1..].iter().zip(moved))
            {
                *difference = (x - other).abs();
            }
            add_row_to_sums(differences, grid.side, &mut sums[grid.regions_of_row(y)]);
        }
        for (score, sum) in scores.iter_mut().zip(sums.iter()) {
            *score = score.min(*sum);
        }
    }
    let n = pixels_per_region(grid);
    for score in scores {
        *score /= n;
    }
}
