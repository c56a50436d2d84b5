// SPDX-License-Identifier: MIT OR Apache-2.0
//! A tensor: a form with its values.

use crate::element::{ElementType, with_element_type};
use crate::mask::Mask;
use crate::tensor_form::TensorForm;
use crate::values::{TensorNumber, TensorValues};
use std::borrow::Cow;

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
pub(crate) fn for_each_run(
    form: &TensorForm,
    at: &Mask,
    mut visit: impl FnMut(std::ops::Range<usize>),
) {
    let (places, inner, ranges) = (form.position_count(), form.inner_size(), at.memory_ranges());
    for outer in 0..form.outer_size() {
        for range in &ranges {
            let start = outer * places;
            visit((start + range.start) * inner..(start + range.end) * inner);
        }
    }
}
