// SPDX-License-Identifier: MIT OR Apache-2.0
//! Softmax and its logarithm.

use super::places::aligned;
use super::sums::rounded;
use super::{Job, Operator, of_bytes, only, values_of};
use crate::element::{Encoding, typed_byte};
use crate::form::Form;
use crate::mask::Mask;
use crate::threads;
use crate::values::Byte;

/// Softmax along one axis, or over all axes from one on.
#[derive(Clone, Debug)]
pub(crate) struct Softmax {
    pub(crate) axis: i64,
    pub(crate) is_to_end: bool,
    /// True for the logarithm of the softmax.
    pub(crate) is_logarithm: bool,
}

impl Softmax {
    /// Returns the number of values that share a sum, and their stride.
    fn line(&self, form: &Form) -> (usize, usize) {
        let axis = form.axis(self.axis).expect("the form has it");
        let behind = form.shape()[axis + 1..].iter().product();
        if self.is_to_end { (form.shape()[axis] * behind, 1) } else { (form.shape()[axis], behind) }
    }

    /// Computes the softmax of the values of one sum, which are `step` apart.
    fn shares(&self, from: &[f32], to: &mut [f32], step: usize) {
        let values = || from.iter().step_by(step);
        let most = values().fold(f32::NEG_INFINITY, |most, &value| most.max(value));
        let sum: f32 = values().map(|value| (value - most).exp()).sum();
        let logarithm = sum.ln();
        for (to, value) in to.iter_mut().step_by(step).zip(values()) {
            *to = if self.is_logarithm {
                value - most - logarithm
            } else {
                (value - most).exp() / sum
            };
        }
    }

    /// Returns the positions of the output that depend on changed positions of the input.
    fn dependent(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        let axis = output.axis(self.axis).expect("the form has it");
        aligned(inputs[0], output, |own| {
            let is_summed = own == axis || (self.is_to_end && own > axis);
            (!is_summed).then_some(own)
        })
    }
}

impl Operator for Softmax {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let form = only(inputs)?;
        form.axis(self.axis)?;
        Ok(form.clone())
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        self.dependent(inputs, output)
    }

    fn compute(&self, job: Job<'_>) {
        let Job { inputs, form, output, .. } = job;
        let (length, step) = self.line(form);
        let (from, plane) = (inputs[0].values::<f32>(), length * step);
        threads::each_chunk(values_of::<f32>(output, form), plane, &|number, to| {
            let from = &from[number * plane..][..plane];
            (0..step).for_each(|first| self.shares(&from[first..], &mut to[first..], step));
        });
    }
}

/// The softmax of 8-bit values.
#[derive(Clone, Debug)]
pub(crate) struct QuantizedSoftmax {
    pub(crate) softmax: Softmax,
    pub(crate) from: Encoding,
    pub(crate) to: Encoding,
}

impl QuantizedSoftmax {
    #[allow(clippy::cast_precision_loss, reason = "differences of 8-bit values")]
    fn shares<T: Byte>(&self, job: Job<'_>) {
        let Job { inputs, form, output, .. } = job;
        let (length, step) = self.softmax.line(form);
        let planes = values_of::<T>(output, form).chunks_mut(length * step);
        let real =
            |&value: &T| (Into::<i32>::into(value) - self.from.zero) as f32 * self.from.scale;
        for (to, from) in planes.zip(inputs[0].values::<T>().chunks(length * step)) {
            let from: Vec<f32> = from.iter().map(real).collect();
            let mut shares = vec![0.0; from.len()];
            (0..step)
                .for_each(|first| self.softmax.shares(&from[first..], &mut shares[first..], step));
            let stored = |share: f32| rounded(share / self.to.scale, self.to.zero);
            to.iter_mut().zip(shares).for_each(|(to, share)| *to = stored(share));
        }
    }
}

impl Operator for QuantizedSoftmax {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        self.softmax.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        of_bytes(inputs, self.to)
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        self.softmax.dependent(inputs, output)
    }

    fn compute(&self, job: Job<'_>) {
        typed_byte!(self.to.element, T => self.shares::<T>(job));
    }
}
