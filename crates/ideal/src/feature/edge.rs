// SPDX-License-Identifier: MIT OR Apache-2.0
//! `edge`: the number of pixels with a 3x3 Sobel magnitude |Gx| + |Gy| above a level.
//!
//! ```text
//!      -1  0 +1          -1 -2 -1
//! Gx:  -2  0 +2     Gy:   0  0  0
//!      -1  0 +1          +1 +2 +1
//! ```

use super::{ScoreBuffers, add_row_to_sums};
use crate::view::FrameView;

/// Counts the hits of every region. Each filter smooths along one axis and takes a difference along
/// the other axis. Its vertical part is computed once per column, because three windows use it.
pub(super) fn score(level: f64, view: &FrameView, scratch: &mut ScoreBuffers, scores: &mut [f64]) {
    let FrameView { grid, denoised: plane, .. } = *view;
    let [smooth, slope, hits] = &mut scratch.lines;
    smooth.resize(plane.width() + 2, 0.0);
    slope.resize(plane.width() + 2, 0.0);
    hits.resize(plane.width(), 0.0);
    scores.fill(0.0);
    for y in 0..plane.height() {
        let [above, middle, below] = plane.window_lines(y);
        let out = smooth.iter_mut().zip(slope.iter_mut());
        for ((smooth, slope), (a, (b, c))) in out.zip(above.iter().zip(middle.iter().zip(below))) {
            *smooth = a + 2.0 * b + c;
            *slope = c - a;
        }
        let (smooth, slope) = (&smooth[..hits.len() + 2], &slope[..hits.len() + 2]);
        for (x, hit) in hits.iter_mut().enumerate() {
            let gx = smooth[x + 2] - smooth[x];
            let gy = slope[x] + 2.0 * slope[x + 1] + slope[x + 2];
            *hit = if gx.abs() + gy.abs() > level { 1.0 } else { 0.0 };
        }
        add_row_to_sums(hits, grid.side, &mut scores[grid.regions_of_row(y)]);
    }
}
