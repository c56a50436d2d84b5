// SPDX-License-Identifier: MIT OR Apache-2.0
//! Values of a tensor.

use crate::form::Form;
use crate::mask::Mask;

/// A tensor of 32-bit floating-point values.
#[derive(Clone, Debug)]
pub struct Tensor {
    form: Form,
    values: Vec<f32>,
}

impl Tensor {
    /// A tensor of zeros.
    #[must_use]
    pub fn zeros(form: Form) -> Self {
        Self { values: vec![0.0; form.elements()], form }
    }

    /// A tensor of these values, in the order of memory.
    ///
    /// # Panics
    /// If there are not as many as the form has elements.
    #[must_use]
    pub fn new(form: Form, values: Vec<f32>) -> Self {
        assert_eq!(form.elements(), values.len(), "a tensor has as many values as its form says");
        Self { form, values }
    }

    /// Its form.
    #[must_use]
    pub fn form(&self) -> &Form {
        &self.form
    }

    /// The values in the order of memory.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The values, to be changed.
    pub fn values_mut(&mut self) -> &mut [f32] {
        &mut self.values
    }

    /// The positions at which a value differs from that of another tensor of the same form, bit by bit.
    #[must_use]
    pub fn differences(&self, other: &Self) -> Mask {
        let (height, width) = (self.form.height(), self.form.width());
        let mut mask = Mask::empty(height, width);
        let inner = self.form.inner();
        for (at, (own, other)) in self.values.iter().zip(&other.values).enumerate() {
            if own.to_bits() != other.to_bits() {
                let place = at / inner % (height * width);
                mask.insert(place % width, place / width);
            }
        }
        mask
    }
}

/// Calls `visit` with the range in memory of every run of positions of `at`, for every outer index.
pub(crate) fn for_each_run(form: &Form, at: &Mask, mut visit: impl FnMut(std::ops::Range<usize>)) {
    let (places, inner, width) = (form.places(), form.inner(), form.width());
    for outer in 0..form.outer() {
        for y in 0..form.height() {
            for (x, length) in at.runs(y) {
                let start = (outer * places + y * width + x) * inner;
                visit(start..start + length * inner);
            }
        }
    }
}
