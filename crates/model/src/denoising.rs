// SPDX-License-Identifier: MIT OR Apache-2.0
//! Frames after the filter, and parts of them.

use std::ops::Range;

use foveate_camera::Camera;

use super::region::FrameRegion;
use crate::region::{RegionArea, black_padded_frame};
use crate::window_filter::filtered_pixel;
use foveate_pixels::Frame;

/// Returns a padded frame after the filter of the camera.
///
/// # Panics
/// Panics if the frame does not have the size of the padded frame of the camera.
#[must_use]
pub fn denoise(camera: &Camera, padded: &Frame) -> Frame {
    let mut denoised = black_padded_frame(camera);
    denoise_into(camera, padded, &mut denoised);
    denoised
}

/// Denoises the padded frame `padded` into `denoised`.
pub(crate) fn denoise_into(camera: &Camera, padded: &Frame, denoised: &mut Frame) {
    if !camera.filter().has_window() {
        denoised.clone_from(padded);
        return;
    }
    for region in 0..camera.regions() {
        let area = RegionArea::from_region(camera, region);
        for y in area.rows() {
            let row = denoised_pixels(camera, padded, region, area.columns(), y);
            denoised.write_row(area.left, y, &row);
        }
    }
}

/// Returns some pixels of row `y` of one region of a padded frame, denoised. The frame must hold
/// all pixels of their windows.
pub(crate) fn denoised_pixels(
    camera: &Camera,
    padded: &Frame,
    region: u32,
    columns: Range<u32>,
    y: u32,
) -> Vec<u16> {
    let filter = camera.filter();
    if !filter.has_window() {
        return columns.map(|x| padded.get(x, y)).collect();
    }
    let view = FrameRegion::new(camera, padded, region);
    columns.map(|x| filtered_pixel(filter, &view.window(x, y))).collect()
}
