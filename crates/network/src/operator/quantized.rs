// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sums, products, means and concatenations of 8-bit values in which each tensor has a separate
//! scale, as onnxruntime defines them.

use super::sums::{Outcome, rounded};
use super::{Arithmetic, Binary, Concat, Job, Operator, Pool, Table, of_bytes, only, values_of};
use super::{everything, wanted};
use crate::element::{Encoding, typed_byte};
use crate::form::Form;
use crate::mask::{Mask, Window};
use crate::values::Byte;

/// The sum or the product of two tensors.
#[derive(Clone, Debug)]
pub(crate) struct QuantizedBinary {
    /// The operation, its operands and the broadcasting.
    pub(crate) binary: Binary,
    pub(crate) from: [Encoding; 2],
    pub(crate) to: Encoding,
}

impl Operator for QuantizedBinary {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        self.binary.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.iter().find(|input| input.element != self.to.element) {
            None => Ok(self.to),
            Some(input) => Err(wanted(self.to.element, input.element)),
        }
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        self.binary.spread(inputs, output)
    }

    #[allow(clippy::cast_precision_loss, reason = "differences and products of 8-bit values")]
    fn compute(&self, job: Job<'_>) {
        let ([a, b], to) = (self.from, self.to);
        typed_byte!(to.element, T => match self.binary.kind {
            Arithmetic::Mul => {
                let factor = a.scale * b.scale / to.scale;
                self.binary.lines(job, |x: T, y: T| {
                    T::of_sum((i32::from(x) - a.zero) * (i32::from(y) - b.zero), factor, to.zero)
                });
            }
            // `read::quantized` makes no other operation than products and sums.
            _ => self.binary.lines(job, |x: T, y: T| {
                let real = |value: T, of: Encoding| (i32::from(value) - of.zero) as f32 * of.scale;
                rounded::<T>((real(x, a) + real(y, b)) / to.scale, to.zero)
            }),
        });
    }

    fn weight_bytes(&self) -> u64 {
        self.binary.weight_bytes()
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
    fn average<T: Byte + Outcome>(&self, job: Job<'_>) {
        let scale = self.from.scale / self.to.scale;
        self.pool.runs(job, |plane: &[T], size, place, run: &mut [T]| {
            let mut sums = vec![0i32; run.len()];
            self.pool.each(plane, size, place, &mut sums, |sum, value| {
                let value: i32 = value.into();
                *sum += value - self.from.zero;
            });
            let counts = self.pool.counts(size, place, self.with_padding);
            for ((to, sum), count) in run.iter_mut().zip(sums).zip(counts) {
                *to = T::of_sum(sum, scale / f32::from(count), self.to.zero);
            }
        });
    }
}

impl Operator for QuantizedPool {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        self.pool.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        of_bytes(inputs, self.to)
    }

    fn windows(&self) -> Option<[Window; 2]> {
        self.pool.windows()
    }

    fn compute(&self, job: Job<'_>) {
        typed_byte!(self.to.element, T => self.average::<T>(job));
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
    fn means<T: Byte>(&self, job: Job<'_>) {
        let Job { inputs, form, output, .. } = job;
        let output: &mut [T] = values_of(output, form);
        let places = inputs[0].form().places();
        for (output, values) in output.iter_mut().zip(inputs[0].values::<T>().chunks(places)) {
            let above_zero = |&value: &T| i64::from(Into::<i32>::into(value) - self.from.zero);
            let sum: i64 = values.iter().map(above_zero).sum();
            let factor = self.from.scale / (self.to.scale * places as f32);
            *output = rounded(sum as f32 * factor, self.to.zero);
        }
    }
}

impl Operator for QuantizedMean {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let [channels, ..] = super::features(only(inputs)?)?;
        Ok(Form::features(vec![1, channels, 1, 1]))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        of_bytes(inputs, self.to)
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        everything(inputs, output)
    }

    fn takes_features(&self) -> bool {
        true
    }

    fn compute(&self, job: Job<'_>) {
        if !job.at.is_empty() {
            typed_byte!(self.to.element, T => self.means::<T>(job));
        }
    }
}

/// The concatenation of tensors, each requantized to the scale of the output.
#[derive(Clone, Debug)]
pub(crate) struct QuantizedConcat {
    pub(crate) concat: Concat,
    /// The requantization table of each input.
    pub(crate) tables: Vec<Table>,
    pub(crate) to: Encoding,
}

impl Operator for QuantizedConcat {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        self.concat.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        for (table, &input) in self.tables.iter().zip(inputs) {
            table.encoding_of(input)?;
        }
        Ok(self.to)
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        self.concat.spread(inputs, output)
    }

    fn compute(&self, job: Job<'_>) {
        typed_byte!(self.to.element, T => {
            self.concat.join(job, |input, from: &[T], to: &mut [T]| {
                self.tables[input].apply(from, to);
            });
        });
    }
}
