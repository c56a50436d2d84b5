// SPDX-License-Identifier: MIT OR Apache-2.0
//! The stream of a region to its RPU: the pixels with their halo, and the sides of the region that
//! are sides of the frame.

use foveate_camera::Camera;

use crate::region::RegionArea;
use foveate_pixels::Frame;

/// Appends the raw pixels that region `region` of a frame sends to its RPU: a square of side
/// `camera.stream_side()` in row-major order. A position outside of the frame holds the nearest
/// pixel, both for padding and for the halo. A padded frame gives the same stream.
pub fn region_stream(camera: &Camera, frame: &Frame, region: u32, out: &mut Vec<u16>) {
    let area = RegionArea::from_region(camera, region);
    let halo = i64::from(camera.halo());
    let reach = |from: u32| i64::from(from) - halo..i64::from(from + area.side) + halo;
    for y in reach(area.top) {
        out.extend(reach(area.left).map(|x| frame.get_clamped(x, y)));
    }
}

/// Bit of [`region_border`] for a left side that is the left side of the frame.
pub(crate) const LEFT: u8 = 0b0001;
/// Bit of [`region_border`] for a right side that is the right side of the frame.
pub(crate) const RIGHT: u8 = 0b0010;
/// Bit of [`region_border`] for an upper side that is the upper side of the frame.
pub(crate) const TOP: u8 = 0b0100;
/// Bit of [`region_border`] for a lower side that is the lower side of the frame.
pub(crate) const BOTTOM: u8 = 0b1000;

/// Returns the sides of a region that are sides of the padded frame, as `border_i` takes them:
/// `{bottom, top, right, left}`, left in bit 0.
#[must_use]
pub fn region_border(camera: &Camera, region: u32) -> u8 {
    let (column, row) = (region % camera.columns(), region / camera.columns());
    [
        (column == 0, LEFT),
        (column + 1 == camera.columns(), RIGHT),
        (row == 0, TOP),
        (row + 1 == camera.rows(), BOTTOM),
    ]
    .into_iter()
    .filter_map(|(touches, bit)| touches.then_some(bit))
    .sum()
}
