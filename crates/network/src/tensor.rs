// SPDX-License-Identifier: MIT OR Apache-2.0
//! A tensor ([`Tensor`]): values with a form, which is a shape, the axes of it that are
//! positions in the frame, and the type of its values ([`TensorForm`]). The input of a model
//! has its axes in an order of its own ([`InputLayout`]).

use crate::element::{ElementType, Encoding, with_element_type};
use crate::mask::Mask;
use crate::values::{TensorNumber, TensorValues};
use std::borrow::Cow;
use std::ops::Range;

/// A tensor: a form with its values.
#[derive(Clone, Debug)]
pub struct Tensor {
    form: TensorForm,
    values: TensorValues,
}

impl Tensor {
    /// Returns a tensor of zeros.
    #[must_use]
    pub fn zeros(form: TensorForm) -> Self {
        Self { values: TensorValues::zeros(form.encoding().element, form.element_count()), form }
    }

    /// Returns a tensor of floating-point values, given in row-major order.
    ///
    /// # Panics
    /// Panics if the number of values is not the number of elements of the form.
    #[must_use]
    pub fn new(form: TensorForm, values: Vec<f32>) -> Self {
        assert_eq!(
            form.element_count(),
            values.len(),
            "a tensor has as many values as its form says"
        );
        Self { form, values: TensorValues::F32(values) }
    }

    /// Returns a tensor of integers, given in row-major order, in the integer type of the form.
    ///
    /// # Errors
    /// Fails, with a message, if a value is outside of the range of the type.
    pub(crate) fn from_integers(form: TensorForm, values: &[i64]) -> Result<Self, String> {
        fn convert_all<T: TryFrom<i64>>(values: &[i64]) -> Result<Vec<T>, String> {
            let converted = |&value: &i64| {
                T::try_from(value)
                    .map_err(|_| format!("a constant of {value} is outside of its bits"))
            };
            values.iter().map(converted).collect()
        }
        let values = match form.encoding().element {
            ElementType::F32 => unreachable!("integers are asked for"),
            ElementType::U8 => TensorValues::U8(convert_all(values)?),
            ElementType::I8 => TensorValues::I8(convert_all(values)?),
            ElementType::I32 => TensorValues::I32(convert_all(values)?),
        };
        Ok(Self { form, values })
    }

    /// The form of the tensor.
    #[must_use]
    pub fn form(&self) -> &TensorForm {
        &self.form
    }

    /// The values in row-major order.
    pub(crate) fn values<T: TensorNumber>(&self) -> &[T] {
        T::slice_of(&self.values)
    }

    /// The stored values, for writing.
    pub(crate) fn values_mut(&mut self) -> &mut TensorValues {
        &mut self.values
    }

    /// The real numbers that the values stand for, in row-major order.
    #[must_use]
    pub fn real_values(&self) -> Cow<'_, [f32]> {
        let encoding = self.form.encoding();
        #[allow(clippy::cast_precision_loss, reason = "a zero point of a sum is 0")]
        let (scale, zero) = (encoding.scale, encoding.zero_point as f32);
        match &self.values {
            TensorValues::F32(values) => Cow::Borrowed(values),
            stored => with_element_type!(encoding.element, T => {
                T::slice_of(stored).iter().map(|value| (value.to_f32() - zero) * scale).collect()
            }),
        }
    }

    /// Returns the positions at which any bit of a value differs from that of another tensor of the
    /// same form.
    #[must_use]
    pub fn differing_positions(&self, other: &Self) -> Mask {
        let (height, width) = (self.form.height(), self.form.width());
        let mut mask = Mask::empty(height, width);
        let inner = self.form.inner_size();
        with_element_type!(self.form.encoding().element, T => {
            let pairs = self.values::<T>().iter().zip(other.values::<T>());
            for (at, (own, other)) in pairs.enumerate() {
                if !own.has_same_bits(*other) {
                    let place = at / inner % (height * width);
                    mask.insert(place % width, place / width);
                }
            }
        });
        mask
    }
}

/// Calls `visit` with the memory range of every run of positions of `at`, for every outer index.
pub(crate) fn for_each_run(form: &TensorForm, at: &Mask, mut visit: impl FnMut(Range<usize>)) {
    let (places, inner, ranges) = (form.position_count(), form.inner_size(), at.memory_ranges());
    for outer in 0..form.outer_size() {
        for range in &ranges {
            let start = outer * places;
            visit((start + range.start) * inner..(start + range.end) * inner);
        }
    }
}

pub(crate) const MAX_AXES: usize = 8;

/// The number of elements of a shape, or `None` if it exceeds `usize`.
pub(crate) fn checked_element_count(shape: &[usize]) -> Option<usize> {
    shape.iter().try_fold(1usize, |product, &length| product.checked_mul(length))
}

/// A shape in which some axes are the rows and columns of the frame.
///
/// In memory a tensor is `outer` x `height` x `width` x `inner` values in row-major order. The
/// features of a convolution have their channels outside (NCHW). After a transposition to NHWC
/// their channels are inside. A tensor without positions, such as the logits of a classifier, has a
/// single position that stands for all of it. Values are floating-point ones unless
/// [`TensorForm::encoding`] says otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorForm {
    shape: Vec<usize>,
    positions: Range<usize>,
    encoding: Encoding,
}

impl TensorForm {
    /// Returns the form of features `[1, channels, height, width]`. A shape with another number of
    /// axes than four has no positions.
    #[must_use]
    pub fn features(shape: Vec<usize>) -> Self {
        if shape.len() == 4 {
            Self::with_positions(shape, 2..4)
        } else {
            Self::without_positions(shape)
        }
    }

    /// Returns the form of a tensor without positions.
    #[must_use]
    pub fn without_positions(shape: Vec<usize>) -> Self {
        Self::with_positions(shape, 0..0)
    }

    /// Returns the form of a shape in which these one or two axes are positions.
    pub(crate) fn with_positions(shape: Vec<usize>, positions: Range<usize>) -> Self {
        debug_assert!(positions.len() <= 2 && positions.end <= shape.len());
        Self { shape, positions, encoding: Encoding::FLOAT }
    }

    /// Returns the form with another encoding.
    pub(crate) fn with_encoding(self, encoding: Encoding) -> Self {
        Self { encoding, ..self }
    }

    /// The type of the stored values, and the real numbers that they stand for.
    #[must_use]
    pub fn encoding(&self) -> Encoding {
        self.encoding
    }

    /// The bytes of all values.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (self.element_count() * self.encoding.element.bytes()) as u64
    }

    /// The length of every axis.
    #[must_use]
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// The number of values.
    #[must_use]
    pub fn element_count(&self) -> usize {
        self.shape.iter().product()
    }

    pub(crate) fn position_axes(&self) -> Range<usize> {
        self.positions.clone()
    }

    /// Returns true if some axes are positions.
    pub(crate) fn has_positions(&self) -> bool {
        !self.positions.is_empty()
    }

    /// The number of rows of positions.
    #[must_use]
    pub fn height(&self) -> usize {
        if self.positions.len() == 2 { self.shape[self.positions.start] } else { 1 }
    }

    /// The number of positions of a row.
    #[must_use]
    pub fn width(&self) -> usize {
        if self.has_positions() { self.shape[self.positions.end - 1] } else { 1 }
    }

    /// The number of positions.
    #[must_use]
    pub fn position_count(&self) -> usize {
        self.height() * self.width()
    }

    /// The product of the axes before the positions: how often the positions are repeated in
    /// memory.
    pub(crate) fn outer_size(&self) -> usize {
        if self.has_positions() { self.shape[..self.positions.start].iter().product() } else { 1 }
    }

    /// The product of the axes behind the positions: the number of neighboring values of a
    /// position.
    pub(crate) fn inner_size(&self) -> usize {
        let from = if self.has_positions() { self.positions.end } else { 0 };
        self.shape[from..].iter().product()
    }

    /// Resolves the number of an axis, which counts from the end if it is negative.
    ///
    /// # Errors
    /// Fails, with a message, if there is no such axis.
    pub(crate) fn resolve_axis(&self, axis: i64) -> Result<usize, String> {
        let count = self.shape.len();
        // The conversion cannot fail, because a network refuses more than `MAX_AXES` axes.
        let from_end = axis.checked_add(i64::try_from(count).expect("a few axes"));
        let resolved = if axis < 0 { from_end.unwrap_or(-1) } else { axis };
        usize::try_from(resolved)
            .ok()
            .filter(|&resolved| resolved < count)
            .ok_or_else(|| format!("{} has no axis {axis}", self.describe()))
    }

    /// The channel, row and column of the value at memory index `place` of features.
    pub(crate) fn coordinates(&self, place: usize) -> (usize, usize, usize) {
        (place / self.position_count(), place / self.width() % self.height(), place % self.width())
    }

    /// The memory index, in a tensor with a stride per axis of this form, of the value at memory
    /// index `place`.
    pub(crate) fn offset(&self, place: usize, steps: &[usize]) -> usize {
        let (mut rest, mut at) = (place, 0);
        for (&size, &step) in self.shape.iter().zip(steps).rev() {
            at += rest % size * step;
            rest /= size;
        }
        at
    }

    /// The stride of every axis, in values.
    pub(crate) fn strides(&self) -> Vec<usize> {
        let mut steps = vec![1; self.shape.len()];
        for axis in (1..steps.len()).rev() {
            steps[axis - 1] = steps[axis] * self.shape[axis];
        }
        steps
    }

    /// The strides of an operand that is broadcast to this form, by axis of this form. The stride
    /// is 0 where the operand is repeated.
    pub(crate) fn broadcast_strides(&self, operand: &Self) -> Vec<usize> {
        let sizes = operand.shape.iter().zip(operand.strides());
        let strides = sizes.map(|(&size, step)| if size == 1 { 0 } else { step });
        std::iter::repeat_n(0, self.shape.len() - operand.shape.len()).chain(strides).collect()
    }

    /// The shape in messages.
    pub(crate) fn describe(&self) -> String {
        let sizes: Vec<String> = self.shape.iter().map(ToString::to_string).collect();
        format!("[{}]", sizes.join(", "))
    }
}

/// The order in which a model takes the axes of its input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputLayout {
    /// Channels, rows, columns.
    Nchw,
    /// Rows, columns, channels, as in models from TensorFlow. Such a model first transposes its
    /// input to put the channels first. The network is read from behind that transposition.
    Nhwc,
}

impl InputLayout {
    /// The usual name of the layout.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nchw => "nchw",
            Self::Nhwc => "nhwc",
        }
    }
}
