// SPDX-License-Identifier: MIT OR Apache-2.0
//! A tensor: a form with its values.

use crate::element::{Element, typed};
use crate::form::Form;
use crate::mask::Mask;
use crate::values::{Number, Values};
use std::borrow::Cow;

/// A tensor: a form with its values.
#[derive(Clone, Debug)]
pub struct Tensor {
    form: Form,
    values: Values,
}

impl Tensor {
    /// Returns a tensor of zeros.
    #[must_use]
    pub fn zeros(form: Form) -> Self {
        Self { values: Values::zeros(form.encoding().element, form.elements()), form }
    }

    /// Returns a tensor of floating-point values, given in row-major order.
    ///
    /// # Panics
    /// Panics if the number of values is not the number of elements of the form.
    #[must_use]
    pub fn new(form: Form, values: Vec<f32>) -> Self {
        assert_eq!(form.elements(), values.len(), "a tensor has as many values as its form says");
        Self { form, values: Values::F32(values) }
    }

    /// Returns a tensor of integers, given in row-major order, in the integer type of the form.
    ///
    /// # Errors
    /// Fails, with a message, if a value is outside of the range of the type.
    pub(crate) fn of_integers(form: Form, values: &[i64]) -> Result<Self, String> {
        fn all<T: TryFrom<i64>>(values: &[i64]) -> Result<Vec<T>, String> {
            let own = |&value: &i64| {
                T::try_from(value)
                    .map_err(|_| format!("a constant of {value} is outside of its bits"))
            };
            values.iter().map(own).collect()
        }
        let values = match form.encoding().element {
            Element::F32 => unreachable!("integers are asked for"),
            Element::U8 => Values::U8(all(values)?),
            Element::I8 => Values::I8(all(values)?),
            Element::I32 => Values::I32(all(values)?),
        };
        Ok(Self { form, values })
    }

    /// The form of the tensor.
    #[must_use]
    pub fn form(&self) -> &Form {
        &self.form
    }

    /// The values in row-major order.
    pub(crate) fn values<T: Number>(&self) -> &[T] {
        T::of(&self.values)
    }

    /// The stored values, for writing.
    pub(crate) fn stored_mut(&mut self) -> &mut Values {
        &mut self.values
    }

    /// The real numbers that the values stand for, in row-major order.
    #[must_use]
    pub fn reals(&self) -> Cow<'_, [f32]> {
        let encoding = self.form.encoding();
        #[allow(clippy::cast_precision_loss, reason = "a zero point of a sum is 0")]
        let (scale, zero) = (encoding.scale, encoding.zero as f32);
        match &self.values {
            Values::F32(values) => Cow::Borrowed(values),
            stored => typed!(encoding.element, T => {
                T::of(stored).iter().map(|value| (value.float() - zero) * scale).collect()
            }),
        }
    }

    /// Returns the positions at which any bit of a value differs from that of another tensor of the
    /// same form.
    #[must_use]
    pub fn differences(&self, other: &Self) -> Mask {
        let (height, width) = (self.form.height(), self.form.width());
        let mut mask = Mask::empty(height, width);
        let inner = self.form.inner();
        typed!(self.form.encoding().element, T => {
            let pairs = self.values::<T>().iter().zip(other.values::<T>());
            for (at, (own, other)) in pairs.enumerate() {
                if !own.is_same(*other) {
                    let place = at / inner % (height * width);
                    mask.insert(place % width, place / width);
                }
            }
        });
        mask
    }
}

/// Calls `visit` with the memory range of every run of positions of `at`, for every outer index.
pub(crate) fn for_each_run(form: &Form, at: &Mask, mut visit: impl FnMut(std::ops::Range<usize>)) {
    let (places, inner, ranges) = (form.places(), form.inner(), at.ranges());
    for outer in 0..form.outer() {
        for range in &ranges {
            let start = outer * places;
            visit((start + range.start) * inner..(start + range.end) * inner);
        }
    }
}
