// SPDX-License-Identifier: MIT OR Apache-2.0
//! `binomial3x3`: the mean of the window around every pixel, with the weights 1, 2, 1 in both
//! directions. It is not rounded, so denoised pixels are sixteenths of a grey level.

use crate::plane::PaddedPlane;

/// Filters a plane into another plane of the same size.
pub(crate) fn filter_binomial(from: &PaddedPlane, to: &mut PaddedPlane) {
    let smooth = |a: f64, b: f64, c: f64| a + 2.0 * b + c;
    for y in 0..from.height() {
        let [above, middle, below] = from.window_lines(y);
        let column = |x: usize| smooth(above[x], middle[x], below[x]);
        for (x, value) in to.row_mut(y).iter_mut().enumerate() {
            *value = smooth(column(x), column(x + 1), column(x + 2)) / 16.0;
        }
    }
    to.repeat_border();
}
