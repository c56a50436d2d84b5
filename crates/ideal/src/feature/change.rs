// SPDX-License-Identifier: MIT OR Apache-2.0
//! The temporal score: the number of pixels of a region that differ from its reference by more than
//! a level.

use super::{Scratch, add_up, pixels_of};
use crate::view::FrameView;

/// Counts the changed pixels of every region. A region without a valid reference counts all its
/// pixels.
pub(crate) fn changed(level: f64, view: &FrameView, scratch: &mut Scratch, changed: &mut [f64]) {
    let FrameView { grid, now, before } = *view;
    let [hits, ..] = &mut scratch.lines;
    hits.resize(now.width(), 0.0);
    changed.fill(0.0);
    for y in 0..now.height() {
        let pairs = now.row(y).iter().zip(before.plane.row(y));
        for (hit, (now, then)) in hits.iter_mut().zip(pairs) {
            *hit = if (now - then).abs() > level { 1.0 } else { 0.0 };
        }
        add_up(hits, grid.side, &mut changed[grid.across(y)]);
    }
    for (changed, valid) in changed.iter_mut().zip(&before.valid) {
        if !valid {
            *changed = pixels_of(grid);
        }
    }
}
