// SPDX-License-Identifier: MIT OR Apache-2.0
//! `corner` (FAST 5/8): the number of pixels that have at least five contiguous neighbors on the
//! ring of eight that are all brighter than `p + level`, or all darker than `p - level`.

use super::{ScoreBuffers, add_row_to_sums};
use crate::view::FrameView;

pub(super) fn score(level: f64, view: &FrameView, scratch: &mut ScoreBuffers, scores: &mut [f64]) {
    let FrameView { grid, denoised: plane, .. } = *view;
    let [hits, ..] = &mut scratch.lines;
    hits.resize(plane.width(), 0.0);
    scores.fill(0.0);
    for y in 0..plane.height() {
        let lines = plane.window_lines(y).map(|line| &line[..hits.len() + 2]);
        for (x, hit) in hits.iter_mut().enumerate() {
            *hit = if is_corner(lines, x, level) { 1.0 } else { 0.0 };
        }
        add_row_to_sums(hits, grid.side, &mut scores[grid.regions_of_row(y)]);
    }
}

/// Returns whether the pixel at column `x` is a corner. The ring starts at the upper left and goes
/// clockwise, with one bit per neighbor.
#[inline(always)]
fn is_corner([above, middle, below]: [&[f64]; 3], x: usize, level: f64) -> bool {
    let ring = [
        above[x],
        above[x + 1],
        above[x + 2],
        middle[x + 2],
        below[x + 2],
        below[x + 1],
        below[x],
        middle[x],
    ];
    let (bright, dark) = (middle[x + 1] + level, middle[x + 1] - level);
    let (mut brighter, mut darker) = (0_u8, 0_u8);
    for value in ring {
        brighter = brighter << 1 | u8::from(value > bright);
        darker = darker << 1 | u8::from(value < dark);
    }
    has_arc(brighter) || has_arc(darker)
}

/// Returns whether at least five contiguous bits are set; bit 0 and bit 7 are neighbors.
fn has_arc(ring: u8) -> bool {
    let two = ring & ring.rotate_left(1);
    let four = two & two.rotate_left(2);
    four & ring.rotate_left(4) != 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_is_five_in_a_row() {
        for ring in 0..=u8::MAX {
            let bits = |start: u32| (start..start + 5).all(|place| ring >> (place % 8) & 1 == 1);
            assert_eq!(has_arc(ring), (0..8).any(bits), "{ring:08b}");
        }
    }
}
