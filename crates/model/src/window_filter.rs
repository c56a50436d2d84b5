// SPDX-License-Identifier: MIT OR Apache-2.0
//! The filters: the denoised pixel at the center of a window of raw pixels.

use foveate_camera::DenoiseFilter;

use crate::window::{CENTER, PixelWindow};

/// Returns the denoised pixel at the center of a window.
#[must_use]
pub fn filtered_pixel(filter: DenoiseFilter, window: &PixelWindow) -> u16 {
    match filter {
        DenoiseFilter::None => window[CENTER],
        DenoiseFilter::Median3x3 => median(window),
        DenoiseFilter::Switching3x3 => switching_median(window),
        DenoiseFilter::Binomial3x3 => binomial_mean(window),
    }
}

/// Returns the median: the fifth of the nine sorted values.
pub(crate) fn median(window: &PixelWindow) -> u16 {
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

/// Returns the median if the center is the largest or the smallest value, else the center.
pub(crate) fn switching_median(window: &PixelWindow) -> u16 {
    let center = window[CENTER];
    let is_largest = window.iter().all(|&pixel| pixel <= center);
    let is_smallest = window.iter().all(|&pixel| pixel >= center);
    if is_largest || is_smallest { median(window) } else { center }
}

/// Returns the mean with the weights of two binomial filters, rounded to the nearest integer; a
/// half is rounded up.
///
/// ```text
/// 1 2 1
/// 2 4 2  / 16
/// 1 2 1
/// ```
pub(crate) fn binomial_mean(window: &PixelWindow) -> u16 {
    const WEIGHTS: [u32; 9] = [1, 2, 1, 2, 4, 2, 1, 2, 1];
    let products = window.iter().zip(WEIGHTS).map(|(&pixel, weight)| u32::from(pixel) * weight);
    let rounded = (products.sum::<u32>() + 8) / 16;
    u16::try_from(rounded).expect("a mean of pixels is at most the largest pixel")
}
