// SPDX-License-Identifier: MIT OR Apache-2.0
//! The filter in front of every score.

use std::ops::Range;

use foveate_camera::{Camera, DenoiseFilter};

use crate::region::{RegionArea, black_padded_frame};
use crate::region_view::FrameRegion;
use crate::window::PixelWindow;
use foveate_frame::Frame;

/// Returns the median: the fifth of the nine sorted values.
#[must_use]
pub fn median(window: &PixelWindow) -> u16 {
    let [a, b, c, d, e, f, g, h, i] = *window;
    let [low, middle, high] = [sort_three(a, b, c), sort_three(d, e, f), sort_three(g, h, i)];
    // The fifth of nine values has four values below it and four above. Of the smallest values of
    // the rows only the largest can be the fifth of all nine, of the largest values only the
    // smallest, and of the middle values only the middle one.
    let [_, _, least] = sort_three(low[0], middle[0], high[0]);
    let [_, between, _] = sort_three(low[1], middle[1], high[1]);
    let [most, _, _] = sort_three(low[2], middle[2], high[2]);
    let [_, median, _] = sort_three(least, between, most);
    median
}

/// Sorts three values without a branch. Sorting all nine values would take most of the time of the
/// model.
fn sort_three(a: u16, b: u16, c: u16) -> [u16; 3] {
    let (low, high) = (a.min(b), a.max(b));
    [low.min(c), low.max(high.min(c)), high.max(c)]
}

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
    match camera.filter() {
        DenoiseFilter::None => denoised.clone_from(padded),
        DenoiseFilter::Median3x3 => {
            for region in 0..camera.regions() {
                let area = RegionArea::from_region(camera, region);
                for y in area.rows() {
                    let row = denoised_pixels(camera, padded, region, area.columns(), y);
                    denoised.write_row(area.left, y, &row);
                }
            }
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
    match camera.filter() {
        DenoiseFilter::None => columns.map(|x| padded.get(x, y)).collect(),
        DenoiseFilter::Median3x3 => {
            let view = FrameRegion::new(camera, padded, region);
            columns.map(|x| median(&view.window(x, y))).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::window::CENTER;

    fn by_sorting(window: &PixelWindow) -> u16 {
        let mut sorted = *window;
        sorted.sort_unstable();
        sorted[CENTER]
    }

    /// The median is made of minima and maxima, which commute with thresholds. So it is right for
    /// all windows if it is right for all windows of zeros and ones.
    #[test]
    fn it_is_the_fifth_of_nine() {
        for bits in 0..512u16 {
            let window = std::array::from_fn(|place| bits >> place & 1);
            assert_eq!(median(&window), by_sorting(&window), "{window:?}");
        }
        let window = [40_000, 3, 65_535, 7, 7, 0, 12, 9, 8];
        assert_eq!((median(&window), by_sorting(&window)), (8, 8));
    }
}
