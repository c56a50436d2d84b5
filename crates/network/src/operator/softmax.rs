// SPDX-License-Identifier: MIT OR Apache-2.0
//! Softmax and its logarithm.

use super::binary_operator::aligned_mask;
use super::quantization::quantize_steps;
use super::{Operator, OperatorJob, encoding_from_bytes, only_input, output_values};
use crate::element::{Encoding, with_byte_type};
use crate::mask::Mask;
use crate::tensor::TensorForm;
use crate::threads;
use crate::values::ByteNumber;

/// Softmax along one axis, or over all axes from one on.
#[derive(Clone, Debug)]
pub(crate) struct Softmax {
    pub(crate) axis: i64,
    pub(crate) spans_following_axes: bool,
    pub(crate) is_logarithm: bool,
}

impl Softmax {
    /// Returns the number of values that share a sum, and their stride.
    fn sum_length_and_stride(&self, form: &TensorForm) -> (usize, usize) {
        let axis = form.resolve_axis(self.axis).expect("the form has it");
        let stride = form.shape()[axis + 1..].iter().product();
        if self.spans_following_axes {
            (form.shape()[axis] * stride, 1)
        } else {
            (form.shape()[axis], stride)
        }
    }

    /// Computes the softmax of the values of one sum, which are `step` apart.
    fn compute_line(&self, from: &[f32], to: &mut [f32], step: usize) {
        let values = || from.iter().step_by(step);
        let largest = values().fold(f32::NEG_INFINITY, |largest, &value| largest.max(value));
        let sum: f32 = values().map(|value| (value - largest).exp()).sum();
        let logarithm = sum.ln();
        for (to, value) in to.iter_mut().step_by(step).zip(values()) {
            *to = if self.is_logarithm {
                value - largest - logarithm
            } else {
                (value - largest).exp() / sum
            };
        }
    }

    /// Returns the positions of the output that depend on changed positions of the input.
    fn dependent_positions(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let axis = output.resolve_axis(self.axis).expect("the form has it");
        aligned_mask(inputs[0], output, |input_axis| {
            let is_summed = input_axis == axis || (self.spans_following_axes && input_axis > axis);
            (!is_summed).then_some(input_axis)
        })
    }
}

impl Operator for Softmax {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let form = only_input(inputs)?;
        form.resolve_axis(self.axis)?;
        Ok(form.clone())
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        self.dependent_positions(inputs, output)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, .. } = job;
        let (length, step) = self.sum_length_and_stride(form);
        let (from, plane) = (inputs[0].values::<f32>(), length * step);
        threads::for_each_chunk(output_values::<f32>(output, form), plane, &|number, to| {
            let from = &from[number * plane..][..plane];
            (0..step).for_each(|first| self.compute_line(&from[first..], &mut to[first..], step));
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
    fn compute_all<T: ByteNumber>(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, .. } = job;
        let (length, step) = self.softmax.sum_length_and_stride(form);
        let planes = output_values::<T>(output, form).chunks_mut(length * step);
        let dequantized =
            |&value: &T| (Into::<i32>::into(value) - self.from.zero_point) as f32 * self.from.scale;
        for (to, from) in planes.zip(inputs[0].values::<T>().chunks(length * step)) {
            let from: Vec<f32> = from.iter().map(dequantized).collect();
            let mut shares = vec![0.0; from.len()];
            (0..step).for_each(|first| {
                self.softmax.compute_line(&from[first..], &mut shares[first..], step);
            });
            let quantized = |share: f32| quantize_steps(share / self.to.scale, self.to.zero_point);
            to.iter_mut().zip(shares).for_each(|(to, share)| *to = quantized(share));
        }
    }
}

impl Operator for QuantizedSoftmax {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        self.softmax.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        encoding_from_bytes(inputs, self.to)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        self.softmax.dependent_positions(inputs, output)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        with_byte_type!(self.to.element, T => self.compute_all::<T>(job));
    }
}
