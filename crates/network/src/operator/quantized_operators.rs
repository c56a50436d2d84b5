// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums, products, means and concatenations of 8-bit values in which each tensor has a separate
//! scale, as onnxruntime defines them.

use super::quantization::{SumOutput, quantize_steps};
use super::{
    ArithmeticKind, BinaryOperator, ByteTable, Concat, Operator, OperatorJob, Pool,
    encoding_from_bytes, full_if_changed, only_input, output_values, wrong_element_message,
};
use crate::element::{Encoding, with_byte_type};
use crate::mask::{AxisWindow, Mask};
use crate::tensor::TensorForm;
use crate::values::ByteNumber;

/// The sum or the product of two tensors.
#[derive(Clone, Debug)]
pub(crate) struct QuantizedBinary {
    /// The operation, its operands and the broadcasting.
    pub(crate) operator: BinaryOperator,
    pub(crate) from: [Encoding; 2],
    pub(crate) to: Encoding,
}

impl Operator for QuantizedBinary {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        self.operator.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.iter().find(|input| input.element != self.to.element) {
            None => Ok(self.to),
            Some(input) => Err(wrong_element_message(self.to.element, input.element)),
        }
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        self.operator.spread(inputs, output)
    }

    #[allow(clippy::cast_precision_loss, reason = "differences and products of 8-bit values")]
    fn compute(&self, job: OperatorJob<'_>) {
        let ([a, b], to) = (self.from, self.to);
        with_byte_type!(to.element, T => match self.operator.kind {
            ArithmeticKind::Mul => {
                let factor = a.scale * b.scale / to.scale;
                self.operator.compute_lines(job, |x: T, y: T| {
                    T::from_sum((i32::from(x) - a.zero_point) * (i32::from(y) - b.zero_point), factor, to.zero_point)
                });
            }
            // The reader makes only products and sums of 8-bit values.
            _ => self.operator.compute_lines(job, |x: T, y: T| {
                let real = |value: T, of: Encoding| (i32::from(value) - of.zero_point) as f32 * of.scale;
                quantize_steps::<T>((real(x, a) + real(y, b)) / to.scale, to.zero_point)
            }),
        });
    }

    fn weight_bytes(&self) -> u64 {
        self.operator.weight_bytes()
    }
}

/// The mean of a window.
#[derive(Clone, Debug)]
pub(crate) struct QuantizedPool {
    pub(crate) pool: Pool,
    pub(crate) with_padding: bool,
    pub(crate) from: Encoding,
    pub(crate) to: Encoding,
}

impl QuantizedPool {
    fn average<T: ByteNumber + SumOutput>(&self, job: OperatorJob<'_>) {
        let scale = self.from.scale / self.to.scale;
        self.pool.fill_runs(job, |plane: &[T], size, place, run: &mut [T]| {
            let mut sums = vec![0i32; run.len()];
            self.pool.accumulate(plane, size, place, &mut sums, |sum, value| {
                let value: i32 = value.into();
                *sum += value - self.from.zero_point;
            });
            let counts = self.pool.window_counts(size, place, self.with_padding);
            for ((to, sum), count) in run.iter_mut().zip(sums).zip(counts) {
                *to = T::from_sum(sum, scale / f32::from(count), self.to.zero_point);
            }
        });
    }
}

impl Operator for QuantizedPool {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        self.pool.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        encoding_from_bytes(inputs, self.to)
    }

    fn axis_windows(&self) -> Option<[AxisWindow; 2]> {
        self.pool.axis_windows()
    }

    fn compute(&self, job: OperatorJob<'_>) {
        with_byte_type!(self.to.element, T => self.average::<T>(job));
    }
}

/// The mean of every channel.
#[derive(Clone, Debug)]
pub(crate) struct QuantizedMean {
    pub(crate) from: Encoding,
    pub(crate) to: Encoding,
}

impl QuantizedMean {
    #[allow(clippy::cast_precision_loss, reason = "a mean is rounded to 8 bits")]
    fn compute_means<T: ByteNumber>(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, .. } = job;
        let output: &mut [T] = output_values(output, form);
        let places = inputs[0].form().position_count();
        for (output, values) in output.iter_mut().zip(inputs[0].values::<T>().chunks(places)) {
            let above_zero =
                |&value: &T| i64::from(Into::<i32>::into(value) - self.from.zero_point);
            let sum: i64 = values.iter().map(above_zero).sum();
            let factor = self.from.scale / (self.to.scale * places as f32);
            *output = quantize_steps(sum as f32 * factor, self.to.zero_point);
        }
    }
}

impl Operator for QuantizedMean {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let [channels, ..] = super::feature_size(only_input(inputs)?)?;
        Ok(TensorForm::features(vec![1, channels, 1, 1]))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        encoding_from_bytes(inputs, self.to)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        full_if_changed(inputs, output)
    }

    fn takes_features(&self) -> bool {
        true
    }

    fn compute(&self, job: OperatorJob<'_>) {
        if !job.positions.is_empty() {
            with_byte_type!(self.to.element, T => self.compute_means::<T>(job));
        }
    }
}

/// The concatenation of tensors, each requantized to the scale of the output.
#[derive(Clone, Debug)]
pub(crate) struct QuantizedConcat {
    pub(crate) concat: Concat,
    /// The requantization table of each input.
    pub(crate) tables: Vec<ByteTable>,
    pub(crate) to: Encoding,
}

impl Operator for QuantizedConcat {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        self.concat.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        for (table, &input) in self.tables.iter().zip(inputs) {
            table.encoding_of(input)?;
        }
        Ok(self.to)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        self.concat.spread(inputs, output)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        with_byte_type!(self.to.element, T => {
            self.concat.copy_inputs(job, |input, from: &[T], to: &mut [T]| {
                self.tables[input].apply(from, to);
            });
        });
    }
}
