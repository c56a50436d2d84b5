// SPDX-License-Identifier: MIT OR Apache-2.0
//! `corner`: FAST 5/8, pixels with five contiguous neighbors all brighter or all darker.

use foveate_camera::Camera;

use crate::view::{FrameRegion, RegionView};
use crate::window::{CENTER, Window};
use foveate_frame::Frame;

/// The neighbors of the center, clockwise from the upper left.
const RING: [usize; 8] = [0, 1, 2, 5, 8, 7, 6, 3];
/// Contiguous neighbors that make a corner.
const ARC: usize = 5;

/// The largest level at which the center is still a corner: it is one iff `level <= strength`, and
/// never one if there is no strength.
///
/// An arc is brighter than `p + level` throughout iff its smallest `x - p` is above the level, so the
/// best arc decides, and it must reach at least 1 for level 0.
#[must_use]
pub fn strength(window: &Window) -> Option<u32> {
    let center = i32::from(window[CENTER]);
    let over = RING.map(|place| i32::from(window[place]) - center);
    let arcs = (0..over.len()).map(|start| {
        let arc = || (start..start + ARC).map(|place| over[place % over.len()]);
        let brighter = arc().min().expect("an arc has pixels");
        let darker = arc().max().expect("an arc has pixels");
        brighter.max(-darker)
    });
    let best = arcs.max().expect("there are arcs");
    u32::try_from(best - 1).ok()
}

/// The strength of every pixel of a region of a denoised padded frame, row by row.
///
/// # Panics
/// When the frame is not as large as the camera's padded frame, or has no such region.
#[must_use]
pub fn corner_strengths(camera: &Camera, denoised: &Frame, region: u32) -> Vec<Option<u32>> {
    FrameRegion::new(camera, denoised, region).windows().map(|window| strength(&window)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_in_a_row_are_needed_and_the_weakest_counts() {
        //   9 9 9      the arc over the top: upper row, right, and lower right or left
        assert_eq!(strength(&[9, 9, 9, 0, 2, 9, 0, 0, 9]), Some(6));
        assert_eq!(strength(&[9, 9, 9, 0, 2, 9, 0, 0, 5]), Some(2));
        assert_eq!(strength(&[9, 9, 9, 2, 2, 9, 2, 2, 2]), None);
        // Around the end of the ring.
        assert_eq!(strength(&[9, 9, 2, 9, 2, 2, 9, 9, 2]), Some(6));
        // Darker.
        assert_eq!(strength(&[1, 1, 1, 5, 4, 1, 5, 5, 1]), Some(2));
        assert_eq!(strength(&[7; 9]), None);
        assert_eq!(strength(&[65535, 65535, 65535, 0, 0, 65535, 0, 0, 65535]), Some(65534));
    }
}
