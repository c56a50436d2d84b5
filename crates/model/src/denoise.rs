// SPDX-License-Identifier: MIT OR Apache-2.0
//! The filter in front of every score.

use foveate_spec::{Design, Filter};

use crate::Frame;
use crate::number::index;
use crate::region::Area;
use crate::window::{CENTER, RegionView, Window};

/// The fifth of the nine sorted values.
#[must_use]
pub fn median(window: &Window) -> u16 {
    let mut sorted = *window;
    sorted.sort_unstable();
    sorted[CENTER]
}

/// A padded frame, denoised as the design says.
///
/// # Panics
/// When the frame is not as large as the design's padded frame.
#[must_use]
pub fn denoise(design: &Design, padded: &Frame) -> Frame {
    let mut denoised = Frame::black_padded(design);
    denoise_into(design, padded, &mut denoised);
    denoised
}

/// Denoises one padded frame into another.
pub(crate) fn denoise_into(design: &Design, padded: &Frame, denoised: &mut Frame) {
    match design.filter() {
        Filter::None => denoised.clone_from(padded),
        Filter::Median3x3 => {
            for region in 0..design.regions() {
                let view = RegionView::new(design, padded, region);
                for (x, y) in Area::of(design, region).positions() {
                    denoised.row_mut(y)[index(x)] = median(&view.window(x, y));
                }
            }
        }
    }
}
