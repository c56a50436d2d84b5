// SPDX-License-Identifier: MIT OR Apache-2.0
//! `switching3x3`: the median where the pixel is the largest or the smallest of its window,
//! elsewhere the pixel itself.

use crate::median::{SortedColumns, filter_median};
use crate::plane::PaddedPlane;

/// Filters a plane into another plane of the same size.
pub(crate) fn filter_switching(
    from: &PaddedPlane,
    to: &mut PaddedPlane,
    columns: &mut SortedColumns,
) {
    filter_median(from, to, columns);
    for y in 0..from.height() {
        let lines = from.window_lines(y);
        for (x, value) in to.row_mut(y).iter_mut().enumerate() {
            let center = lines[1][x + 1];
            let mut window = lines.iter().flat_map(|line| &line[x..x + 3]);
            let has_lower = window.clone().any(|&other| other < center);
            let has_higher = window.any(|&other| other > center);
            if has_lower && has_higher {
                *value = center;
            }
        }
    }
    to.repeat_border();
}
