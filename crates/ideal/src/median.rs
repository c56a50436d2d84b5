// SPDX-License-Identifier: MIT OR Apache-2.0
//! `median3x3`: the fifth of the nine sorted values around every pixel.

use crate::plane::PaddedPlane;

/// The three values of every column of the windows of one row, sorted.
#[derive(Clone, Debug, Default)]
pub(crate) struct SortedColumns {
    low: Vec<f64>,
    middle: Vec<f64>,
    high: Vec<f64>,
}

/// Filters a plane into another plane of the same size. The three windows that contain a column
/// share its sorted values.
pub(crate) fn filter_median(from: &PaddedPlane, to: &mut PaddedPlane, columns: &mut SortedColumns) {
    for y in 0..from.height() {
        columns.sort(from.window_lines(y));
        columns.medians(to.row_mut(y));
    }
    to.repeat_border();
}

impl SortedColumns {
    fn sort(&mut self, [above, middle_line, below]: [&[f64]; 3]) {
        for list in [&mut self.low, &mut self.middle, &mut self.high] {
            list.resize(middle_line.len(), 0.0);
        }
        let out = self.low.iter_mut().zip(&mut self.middle).zip(&mut self.high);
        for ((&a, (&b, &c)), ((low, middle), high)) in
            above.iter().zip(middle_line.iter().zip(below)).zip(out)
        {
            (*low, *middle, *high) = sorted(a, b, c);
        }
    }

    /// Writes the medians of one row. With sorted columns, the median of nine is the median of
    /// three values: the largest low value, the median of the middle values and the smallest high
    /// value.
    fn medians(&self, out: &mut [f64]) {
        let len = out.len();
        let three = |list: &[f64], x: usize| (list[x], list[x + 1], list[x + 2]);
        let (low, middle, high) =
            (&self.low[..len + 2], &self.middle[..len + 2], &self.high[..len + 2]);
        for (x, value) in out.iter_mut().enumerate() {
            let (a, b, c) = three(low, x);
            let max_of_lows = larger(larger(a, b), c);
            let (a, b, c) = three(middle, x);
            let (_, median_of_middles, _) = sorted(a, b, c);
            let (a, b, c) = three(high, x);
            let min_of_highs = smaller(smaller(a, b), c);
            *value = sorted(max_of_lows, median_of_middles, min_of_highs).1;
        }
    }
}

fn sorted(a: f64, b: f64, c: f64) -> (f64, f64, f64) {
    let (low, high) = (smaller(a, b), larger(a, b));
    (smaller(low, c), larger(low, smaller(high, c)), larger(high, c))
}

// `f64::min` and `f64::max` also handle NaN, which costs time; pixels are never NaN.
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Zeros and ones are enough, because minima and maxima commute with thresholds.
    #[test]
    fn the_median_is_the_fifth_of_nine_values() {
        for bits in 0..512_u16 {
            let nine: Vec<f64> = (0..9).map(|place| f64::from(bits >> place & 1)).collect();
            let mut columns = SortedColumns::default();
            columns.sort([&nine[..3], &nine[3..6], &nine[6..]]);
            let mut out = [0.0];
            columns.medians(&mut out);
            let mut sorted = nine.clone();
            sorted.sort_by(f64::total_cmp);
            assert_eq!(out[0], sorted[4], "{nine:?}");
        }
    }
}
