// SPDX-License-Identifier: MIT OR Apache-2.0
//! The shape of a tensor, which of its axes are positions in the picture, and how its values are stored.

use crate::element::Encoding;
use std::ops::Range;

/// Axes that a tensor of a network has at most.
pub(crate) const MAX_AXES: usize = 8;

/// The number of elements of a shape; nothing if no memory could hold so many.
pub(crate) fn elements_of(shape: &[usize]) -> Option<usize> {
    shape.iter().try_fold(1usize, |product, &length| product.checked_mul(length))
}

/// A shape, of which some axes are the rows and columns of the picture.
///
/// In memory a tensor is `outer` x `height` x `width` x `inner` values, row by row. The features of a convolution have their channels
/// outside; after a transposition to NHWC they are inside. A tensor without positions, such as the logits of a classifier, has one position
/// that stands for everything. Values are floating-point ones unless said otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    shape: Vec<usize>,
    positions: Range<usize>,
    encoding: Encoding,
}

impl Form {
    /// Features `[1, channels, height, width]`, or any other shape with two axes after the first two.
    #[must_use]
    pub fn features(shape: Vec<usize>) -> Self {
        if shape.len() == 4 { Self::at(shape, 2..4) } else { Self::whole(shape) }
    }

    /// A tensor without positions.
    #[must_use]
    pub fn whole(shape: Vec<usize>) -> Self {
        Self::at(shape, 0..0)
    }

    /// A shape with these axes, one or two, as positions.
    pub(crate) fn at(shape: Vec<usize>, positions: Range<usize>) -> Self {
        debug_assert!(positions.len() <= 2 && positions.end <= shape.len());
        Self { shape, positions, encoding: Encoding::FLOAT }
    }

    /// The same with values of another kind.
    pub(crate) fn encoded(self, encoding: Encoding) -> Self {
        Self { encoding, ..self }
    }

    /// How its values are stored, and what they stand for.
    #[must_use]
    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// Bytes of all values.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (self.elements() * self.encoding.element.bytes()) as u64
    }

    /// The length of every axis.
    #[must_use]
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Values in all.
    #[must_use]
    pub fn elements(&self) -> usize {
        self.shape.iter().product()
    }

    /// The axes that are positions.
    pub(crate) fn axes(&self) -> Range<usize> {
        self.positions.clone()
    }

    /// Whether it has positions at all.
    pub(crate) fn has_positions(&self) -> bool {
        !self.positions.is_empty()
    }

    /// Rows of positions.
    #[must_use]
    pub fn height(&self) -> usize {
        if self.positions.len() == 2 { self.shape[self.positions.start] } else { 1 }
    }

    /// Positions of a row.
    #[must_use]
    pub fn width(&self) -> usize {
        if self.has_positions() { self.shape[self.positions.end - 1] } else { 1 }
    }

    /// Positions in all.
    #[must_use]
    pub fn places(&self) -> usize {
        self.height() * self.width()
    }

    /// Values outside the positions: how often all positions come one after the other.
    pub(crate) fn outer(&self) -> usize {
        if self.has_positions() { self.shape[..self.positions.start].iter().product() } else { 1 }
    }

    /// Values inside a position, one after the other.
    pub(crate) fn inner(&self) -> usize {
        let from = if self.has_positions() { self.positions.end } else { 0 };
        self.shape[from..].iter().product()
    }

    /// An axis, counted from the end where it is negative.
    ///
    /// # Errors
    /// In words, when there is no such axis.
    pub(crate) fn axis(&self, axis: i64) -> Result<usize, String> {
        let count = self.shape.len();
        // A network refuses forms of more than `MAX_AXES`.
        let from_end = axis.checked_add(i64::try_from(count).expect("a few axes"));
        let own = if axis < 0 { from_end.unwrap_or(-1) } else { axis };
        usize::try_from(own)
            .ok()
            .filter(|&own| own < count)
            .ok_or_else(|| format!("{} has no axis {axis}", self.describe()))
    }

    /// The channel, row and column of a value of features.
    pub(crate) fn coordinates(&self, place: usize) -> (usize, usize, usize) {
        (place / self.places(), place / self.width() % self.height(), place % self.width())
    }

    /// Where a value is in a tensor that has, for each axis of this form, so many values from one index to the next.
    pub(crate) fn offset(&self, place: usize, steps: &[usize]) -> usize {
        let (mut rest, mut at) = (place, 0);
        for (&size, &step) in self.shape.iter().zip(steps).rev() {
            at += rest % size * step;
            rest /= size;
        }
        at
    }

    /// Values from one index of every axis to the next.
    pub(crate) fn steps(&self) -> Vec<usize> {
        let mut steps = vec![1; self.shape.len()];
        for axis in (1..steps.len()).rev() {
            steps[axis - 1] = steps[axis] * self.shape[axis];
        }
        steps
    }

    /// Values of an operand from one index of each axis of this form to the next; 0 where the operand is repeated.
    pub(crate) fn steps_of(&self, operand: &Self) -> Vec<usize> {
        let sizes = operand.shape.iter().zip(operand.steps());
        let own = sizes.map(|(&size, step)| if size == 1 { 0 } else { step });
        std::iter::repeat_n(0, self.shape.len() - operand.shape.len()).chain(own).collect()
    }

    /// The shape as messages show it.
    pub(crate) fn describe(&self) -> String {
        let sizes: Vec<String> = self.shape.iter().map(ToString::to_string).collect();
        format!("[{}]", sizes.join(", "))
    }
}
