// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sets of positions of a tensor, such as those that may have changed, with one bit per position.

use std::ops::Range;

/// A set of positions of a tensor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    height: usize,
    width: usize,
    /// The words of a row; bit `x % 64` of word `x / 64` is the position in column x.
    words_per_row: usize,
    words: Vec<u64>,
}

/// The dependence of the positions of an output on those of an input along one axis: output `o`
/// sees the inputs `o * stride - padding_before + k * dilation`, for `k` from 0 to `kernel - 1`, as
/// far as these inputs exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisWindow {
    /// The number of inputs that an output sees.
    pub kernel: usize,
    /// The distance of the windows of neighboring outputs, in inputs.
    pub stride: usize,
    /// The distance of neighboring taps, in inputs.
    pub dilation: usize,
    /// The padding before the first input.
    pub padding_before: usize,
    /// The padding after the last input.
    pub padding_after: usize,
}

impl AxisWindow {
    /// The window of an output that sees only the input at its own position.
    pub const SAME: Self =
        Self { kernel: 1, stride: 1, dilation: 1, padding_before: 0, padding_after: 0 };

    /// The number of inputs from the first tap to the last, both included.
    #[must_use]
    pub fn span(&self) -> usize {
        (self.kernel - 1) * self.dilation + 1
    }

    /// Returns the input of a tap, or `None` if the tap lies in the padding.
    #[inline(always)]
    pub(crate) fn input_index(&self, output: usize, tap: usize, inputs: usize) -> Option<usize> {
        let at = (output * self.stride + tap * self.dilation).checked_sub(self.padding_before)?;
        (at < inputs).then_some(at)
    }
}

impl Mask {
    /// Returns a mask without positions.
    #[must_use]
    pub fn empty(height: usize, width: usize) -> Self {
        let pitch = width.div_ceil(64);
        Self { height, width, words_per_row: pitch, words: vec![0; pitch * height] }
    }

    /// Returns a mask of all positions.
    #[must_use]
    pub fn full(height: usize, width: usize) -> Self {
        let mut mask = Self::empty(height, width);
        mask.fill();
        mask
    }

    /// Returns the mask of the positions for which `is(x, y)` holds.
    #[must_use]
    pub fn from_fn(height: usize, width: usize, is: impl Fn(usize, usize) -> bool) -> Self {
        let mut mask = Self::empty(height, width);
        for y in 0..height {
            for x in 0..width {
                if is(x, y) {
                    mask.insert(x, y);
                }
            }
        }
        mask
    }

    /// The number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The number of positions of a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// The number of positions in the mask.
    #[must_use]
    pub fn count(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Returns true if no position is in the mask.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// Returns true if the position in column `x` of row `y` is in the mask.
    #[must_use]
    pub fn contains(&self, x: usize, y: usize) -> bool {
        self.words[y * self.words_per_row + x / 64] >> (x % 64) & 1 == 1
    }

    /// Adds the position in column `x` of row `y`.
    pub fn insert(&mut self, x: usize, y: usize) {
        self.words[y * self.words_per_row + x / 64] |= 1 << (x % 64);
    }

    /// Removes the position in column `x` of row `y`.
    pub fn remove(&mut self, x: usize, y: usize) {
        self.words[y * self.words_per_row + x / 64] &= !(1 << (x % 64));
    }

    /// Adds every position.
    pub fn fill(&mut self) {
        for y in 0..self.height {
            let row = &mut self.words[y * self.words_per_row..][..self.words_per_row];
            row.fill(u64::MAX);
            if !self.width.is_multiple_of(64)
                && let Some(last) = row.last_mut()
            {
                *last = (1 << (self.width % 64)) - 1;
            }
        }
    }

    /// Adds the positions of another mask of the same size.
    pub fn union(&mut self, other: &Self) {
        debug_assert_eq!((self.height, self.width), (other.height, other.width));
        for (own, other) in self.words.iter_mut().zip(&other.words) {
            *own |= other;
        }
    }

    /// Returns true if every position of this mask is in another mask of the same size, too.
    #[must_use]
    pub fn is_subset(&self, other: &Self) -> bool {
        self.words.iter().zip(&other.words).all(|(own, other)| own & !other == 0)
    }

    /// Returns the runs of neighboring positions of row `y`, each as its first column and its
    /// length.
    pub fn runs(&self, y: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let row = self.row(y);
        let mut from = 0;
        std::iter::from_fn(move || {
            let start = next_position(row, from, self.width, false)?;
            let end = next_position(row, start, self.width, true).unwrap_or(self.width);
            from = end;
            Some((start, end - start))
        })
    }

    /// Returns the runs of positions that follow each other in memory. A run at the end of a row is
    /// joined with a run at the beginning of the next row.
    pub(crate) fn memory_ranges(&self) -> Vec<Range<usize>> {
        let mut ranges: Vec<Range<usize>> = Vec::new();
        for y in 0..self.height {
            for (x, length) in self.runs(y) {
                let start = y * self.width + x;
                match ranges.last_mut() {
                    Some(last) if last.end == start => last.end += length,
                    _ => ranges.push(start..start + length),
                }
            }
        }
        ranges
    }

    /// Adds positions by marks: mark `i` belongs to memory index `start + i`, and adds its position
    /// unless it is 0.
    pub(crate) fn insert_marked(&mut self, start: usize, mut marks: &[u32]) {
        let (mut x, mut y) = (start % self.width, start / self.width);
        while !marks.is_empty() {
            // One step sets bits of a single word of a row.
            let (marks_of_word, rest) =
                marks.split_at(marks.len().min(64 - x % 64).min(self.width - x));
            let word = |word, (bit, &mark): (usize, &u32)| word | u64::from(mark != 0) << bit;
            let word = marks_of_word.iter().enumerate().fold(0, word);
            self.words[y * self.words_per_row + x / 64] |= word << (x % 64);
            x += marks_of_word.len();
            if x == self.width {
                (x, y) = (0, y + 1);
            }
            marks = rest;
        }
    }

    /// Returns the positions of `height` x `width` outputs that see a position of this mask through
    /// a window.
    #[must_use]
    pub fn outputs_through(
        &self,
        rows: AxisWindow,
        columns: AxisWindow,
        height: usize,
        width: usize,
    ) -> Self {
        let mut outputs = Self::empty(height, width);
        let mut line = vec![0; self.words_per_row];
        for y in 0..height {
            line.fill(0);
            for tap in 0..rows.kernel {
                if let Some(input) = rows.input_index(y, tap, self.height) {
                    for (line, word) in line.iter_mut().zip(self.row(input)) {
                        *line |= word;
                    }
                }
            }
            if line.iter().any(|&word| word != 0) {
                outputs.insert_outputs_of(y, &line, self.width, columns);
            }
        }
        outputs
    }

    /// Returns the positions of `height` x `width` inputs that an output at a position of this mask
    /// sees through a window.
    #[must_use]
    pub fn inputs_through(
        &self,
        rows: AxisWindow,
        columns: AxisWindow,
        height: usize,
        width: usize,
    ) -> Self {
        let mut inputs = Self::empty(height, width);
        let mut line = Self::empty(1, width);
        for y in (0..self.height).filter(|&y| self.row(y).iter().any(|&word| word != 0)) {
            line.words.fill(0);
            for (x, count) in self.runs(y) {
                (x..x + count).for_each(|x| line.insert_inputs_of(x, columns));
            }
            for input in (0..rows.kernel).filter_map(|tap| rows.input_index(y, tap, height)) {
                let row = &mut inputs.words[input * inputs.words_per_row..][..inputs.words_per_row];
                row.iter_mut().zip(&line.words).for_each(|(row, word)| *row |= word);
            }
        }
        inputs
    }

    /// Adds the inputs that output `x` sees to this mask, which has a single row.
    fn insert_inputs_of(&mut self, x: usize, columns: AxisWindow) {
        let inputs = (0..columns.kernel).filter_map(|tap| columns.input_index(x, tap, self.width));
        inputs.for_each(|input| self.words[input / 64] |= 1 << (input % 64));
    }

    /// The number of positions that are not in another mask of the same size.
    #[must_use]
    pub fn count_outside(&self, other: &Self) -> usize {
        let words = self.words.iter().zip(&other.words);
        words.map(|(own, other)| (own & !other).count_ones() as usize).sum()
    }

    /// Scales the mask to a tensor of another size. A position of that tensor is in the result if
    /// it covers a position of this mask.
    #[must_use]
    pub fn scaled_to(&self, height: usize, width: usize) -> Self {
        let range = |outputs: usize, inputs: usize| -> Vec<(usize, usize)> {
            // Output `at` covers the inputs up to the start of the next output, but at least one.
            let first = |at: usize| (at * inputs / outputs).min(inputs - 1);
            (0..outputs)
                .map(|at| (first(at), ((at + 1) * inputs).div_ceil(outputs).max(first(at) + 1) - 1))
                .collect()
        };
        self.outputs_of_ranges(&range(height, self.height), &range(width, self.width))
    }

    /// Returns the positions of outputs that see a position of this mask. Output `i` of an axis
    /// sees the inputs of range `i`, which is given by its first and its last input.
    #[must_use]
    pub fn outputs_of_ranges(&self, rows: &[(usize, usize)], columns: &[(usize, usize)]) -> Self {
        let mut outputs = Self::empty(rows.len(), columns.len());
        let has_position = |y: usize| self.row(y).iter().any(|&word| word != 0);
        for (y, &(top, bottom)) in rows.iter().enumerate() {
            if !(top..=bottom).any(has_position) {
                continue;
            }
            for (x, &(left, right)) in columns.iter().enumerate() {
                if self.has_any(top..bottom + 1, left..right + 1) {
                    outputs.insert(x, y);
                }
            }
        }
        outputs
    }

    /// Returns true if the mask has a position in these rows and columns.
    pub(crate) fn has_any(&self, mut rows: Range<usize>, columns: Range<usize>) -> bool {
        rows.any(|y| next_position(self.row(y), columns.start, columns.end, false).is_some())
    }

    /// Adds to row `y` the outputs that see a position of `line`, a row of `inputs` positions.
    fn insert_outputs_of(&mut self, y: usize, line: &[u64], inputs: usize, columns: AxisWindow) {
        let row = &mut self.words[y * self.words_per_row..][..self.words_per_row];
        if columns.stride == 1 {
            for tap in 0..columns.kernel {
                or_shifted(row, line, columns.padding_before, tap * columns.dilation);
            }
            if !self.width.is_multiple_of(64)
                && let Some(last) = row.last_mut()
            {
                *last &= (1 << (self.width % 64)) - 1;
            }
            return;
        }
        let mut from = 0;
        while let Some(x) = next_position(line, from, inputs, false) {
            for tap in 0..columns.kernel {
                let Some(at) = (x + columns.padding_before).checked_sub(tap * columns.dilation)
                else {
                    continue;
                };
                if at % columns.stride == 0 && at / columns.stride < self.width {
                    row[at / columns.stride / 64] |= 1 << (at / columns.stride % 64);
                }
            }
            from = x + 1;
        }
    }

    fn row(&self, y: usize) -> &[u64] {
        &self.words[y * self.words_per_row..][..self.words_per_row]
    }
}

/// Returns the first position in `from..end` that is in the row, or the first that is not in it if
/// `is_gap`.
fn next_position(row: &[u64], from: usize, end: usize, is_gap: bool) -> Option<usize> {
    let mut at = from;
    while at < end {
        let word = if is_gap { !row[at / 64] } else { row[at / 64] };
        let left = word >> (at % 64);
        if left != 0 {
            let found = at + left.trailing_zeros() as usize;
            return (found < end).then_some(found);
        }
        at = (at / 64 + 1) * 64;
    }
    None
}

/// Adds the bits of `line`, shifted up by `up` and down by `down`.
fn or_shifted(row: &mut [u64], line: &[u64], up: usize, down: usize) {
    let word =
        |at: isize| usize::try_from(at).ok().and_then(|at| line.get(at)).copied().unwrap_or(0);
    // Bit x of the result is bit `x - up + down` of the line.
    let by = down.cast_signed() - up.cast_signed();
    let (words, bits) = (by.div_euclid(64), by.rem_euclid(64));
    for (at, row) in row.iter_mut().enumerate() {
        let low = word(at.cast_signed() + words) >> bits;
        let high = if bits == 0 { 0 } else { word(at.cast_signed() + words + 1) << (64 - bits) };
        *row |= low | high;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn window() -> impl Strategy<Value = AxisWindow> {
        (1..6usize, 1..4usize, 1..4usize, 0..6usize, 0..6usize).prop_map(
            |(kernel, stride, dilation, before, after)| AxisWindow {
                kernel,
                stride,
                dilation,
                padding_before: before,
                padding_after: after,
            },
        )
    }

    proptest! {
        #[test]
        fn outputs_and_inputs_through_windows_equal_those_of_a_naive_search(
            rows in window(), columns in window(), bits in proptest::collection::vec(any::<u32>(), 7),
            width in 1..140usize, height in 1..7usize,
        ) {
            let is = |x: usize, y: usize| bits[y] >> (x * 7 % 32) & 1 == 1 && !x.is_multiple_of(3);
            let mask = Mask::from_fn(height, width, is);
            let (out_height, out_width) = (height + 3, width.div_ceil(columns.stride) + 2);
            let seen = mask.outputs_through(rows, columns, out_height, out_width);
            let naive = Mask::from_fn(out_height, out_width, |x, y| {
                (0..rows.kernel).filter_map(|tap| rows.input_index(y, tap, height)).any(|y| {
                    (0..columns.kernel).filter_map(|tap| columns.input_index(x, tap, width)).any(|x| is(x, y))
                })
            });
            prop_assert_eq!(seen, naive);
            // In the other direction, the mask holds positions of outputs.
            let (in_height, in_width) = (height * rows.stride + 2, width * columns.stride + 3);
            let inputs = mask.inputs_through(rows, columns, in_height, in_width);
            let mut naive = Mask::empty(in_height, in_width);
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).filter(|&(x, y)| is(x, y)) {
                for y in (0..rows.kernel).filter_map(|tap| rows.input_index(y, tap, in_height)) {
                    for x in (0..columns.kernel).filter_map(|tap| columns.input_index(x, tap, in_width)) {
                        naive.insert(x, y);
                    }
                }
            }
            prop_assert_eq!(inputs.count_outside(&naive) + naive.count_outside(&inputs), 0);
            prop_assert_eq!(inputs.count_outside(&Mask::empty(in_height, in_width)), naive.count());
        }

        #[test]
        fn runs_cover_the_positions_of_the_mask(bits in any::<u128>(), width in 1..128usize) {
            let mask = Mask::from_fn(1, width, |x, _| bits >> x & 1 == 1);
            let mut rebuilt = Mask::empty(1, width);
            let mut previous_end = None;
            for (start, length) in mask.runs(0) {
                prop_assert!(length > 0 && previous_end.is_none_or(|end| end < start));
                (start..start + length).for_each(|x| rebuilt.insert(x, 0));
                previous_end = Some(start + length);
            }
            prop_assert_eq!(&mask, &rebuilt);
            prop_assert_eq!(mask.count(), (0..width).filter(|x| bits >> x & 1 == 1).count());
        }
    }

    #[test]
    fn a_full_mask_has_no_bits_beyond_its_rows() {
        for width in [1, 63, 64, 65, 200] {
            let mask = Mask::full(3, width);
            assert_eq!(mask.count(), 3 * width);
            assert_eq!(mask, Mask::from_fn(3, width, |_, _| true));
        }
    }
}
