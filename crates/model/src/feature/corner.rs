// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `corner`, FAST 5/8: pixels with five contiguous neighbors that are all brighter or
//! all darker.

use foveate_camera::Camera;

use crate::region::{FrameRegion, RegionView};
use crate::window::{CENTER, PixelWindow};
use foveate_pixels::Frame;

/// The positions of the neighbors of the center in a window, clockwise from the upper left.
const RING: [usize; 8] = [0, 1, 2, 5, 8, 7, 6, 3];
/// Number of contiguous neighbors that make a corner.
const ARC: usize = 5;

/// Returns the largest level at which the center is a corner: it is one if and only if
/// `level <= strength`. Returns `None` if the center is not a corner at any level.
///
/// All pixels of an arc are brighter than `p + level` if and only if the smallest `x - p` of the
/// arc is above the level. So the best arc decides, and its difference must be at least 1 for level
/// 0.
#[must_use]
pub fn corner_strength(window: &PixelWindow) -> Option<u32> {
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

/// Returns the strength of every pixel of a region of a denoised padded frame, in row-major order.
///
/// # Panics
/// Panics if the frame does not have the size of the padded frame of the camera, or has no such
/// region.
#[must_use]
pub fn corner_strengths(camera: &Camera, denoised: &Frame, region: u32) -> Vec<Option<u32>> {
    FrameRegion::new(camera, denoised, region)
        .windows()
        .map(|window| corner_strength(&window))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_in_a_row_are_needed_and_the_weakest_counts() {
        // The arc over the top has the upper row, the right pixel, and the lower right or the left
        // pixel.
        assert_eq!(corner_strength(&[9, 9, 9, 0, 2, 9, 0, 0, 9]), Some(6));
        assert_eq!(corner_strength(&[9, 9, 9, 0, 2, 9, 0, 0, 5]), Some(2));
        assert_eq!(corner_strength(&[9, 9, 9, 2, 2, 9, 2, 2, 2]), None);
        // The arc goes around the end of the ring.
        assert_eq!(corner_strength(&[9, 9, 2, 9, 2, 2, 9, 9, 2]), Some(6));
        // The arc is darker than the center.
        assert_eq!(corner_strength(&[1, 1, 1, 5, 4, 1, 5, 5, 1]), Some(2));
        assert_eq!(corner_strength(&[7; 9]), None);
        assert_eq!(corner_strength(&[65535, 65535, 65535, 0, 0, 65535, 0, 0, 65535]), Some(65534));
    }
}
