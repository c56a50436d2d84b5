// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `edge`: pixels whose 3x3 Sobel magnitude `|Gx| + |Gy|` is above a level.

use foveate_camera::Camera;

use crate::region::{FrameRegion, RegionView};
use crate::window::PixelWindow;
use foveate_pixels::Frame;

/// Returns the Sobel magnitude `|Gx| + |Gy|` of the center.
///
/// ```text
///      -1  0 +1          -1 -2 -1
/// Gx:  -2  0 +2     Gy:   0  0  0
///      -1  0 +1          +1 +2 +1
/// ```
#[must_use]
pub fn edge_magnitude(window: &PixelWindow) -> u32 {
    let [nw, n, ne, w, _, e, sw, s, se] = *window;
    let side = |a: u16, b: u16, c: u16| i32::from(a) + 2 * i32::from(b) + i32::from(c);
    let gx = side(ne, e, se) - side(nw, w, sw);
    let gy = side(sw, s, se) - side(nw, n, ne);
    gx.unsigned_abs() + gy.unsigned_abs()
}

/// Returns the magnitude of every pixel of a region of a denoised padded frame, in row-major order.
/// A pixel is a hit if its magnitude is above the level.
///
/// # Panics
/// Panics if the frame does not have the size of the padded frame of the camera, or has no such
/// region.
#[must_use]
pub fn edge_magnitudes(camera: &Camera, denoised: &Frame, region: u32) -> Vec<u32> {
    FrameRegion::new(camera, denoised, region)
        .windows()
        .map(|window| edge_magnitude(&window))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_a_diagonal_and_the_maximum() {
        assert_eq!(edge_magnitude(&[0, 0, 9, 0, 0, 9, 0, 0, 9]), 36);
        assert_eq!(edge_magnitude(&[9, 0, 0, 9, 0, 0, 9, 0, 0]), 36);
        assert_eq!(edge_magnitude(&[0, 0, 0, 0, 0, 9, 0, 9, 9]), 54);
        assert_eq!(edge_magnitude(&[0, 0, 0, 0, 7, 65535, 0, 65535, 65535]), 6 * 65535);
        assert_eq!(edge_magnitude(&[4, 4, 4, 4, 0, 4, 4, 4, 4]), 0);
    }
}
