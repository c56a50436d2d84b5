// SPDX-License-Identifier: MIT OR Apache-2.0
//! The temporal score: the number of pixels of a region that differ from its reference by more than
//! a level.

use super::{ScoreBuffers, add_row_to_sums, pixels_per_region};
use crate::view::FrameView;

/// Counts the changed pixels of every region. A region without a valid reference counts all its
/// pixels.
pub(crate) fn count_changed_pixels(
    level: f64,
    view: &FrameView,
    scratch: &mut ScoreBuffers,
    changed: &mut [f64],
) {
    let FrameView { grid, denoised: current, references } = *view;
    let [hits, ..] = &mut scratch.lines;
    hits.resize(current.width(), 0.0);
    changed.fill(0.0);
    for y in 0..current.height() {
        let pairs = current.row(y).iter().zip(references.plane.row(y));
        for (hit, (current, referenced)) in hits.iter_mut().zip(pairs) {
            *hit = if (current - referenced).abs() > level { 1.0 } else { 0.0 };
        }
        add_row_to_sums(hits, grid.side, &mut changed[grid.regions_of_row(y)]);
    }
    for (changed, valid) in changed.iter_mut().zip(&references.valid) {
        if !valid {
            *changed = pixels_per_region(grid);
        }
    }
}
