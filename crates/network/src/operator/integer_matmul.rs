// SPDX-License-Identifier: MIT OR Apache-2.0
//! The product of the last axis of 8-bit values with a constant matrix of 8-bit values, as in fully
//! connected layers.

use super::integer_conv::Rows;
use super::linear::along_last;
use super::sums::{Outcome, Sums};
use super::{Job, Operator, Products, of_bytes, values_of};
use crate::element::{Encoding, typed, typed_byte};
use crate::form::Form;
use crate::mask::Mask;
use crate::threads;
use crate::values::Byte;

#[derive(Clone, Debug)]
pub(crate) struct IntegerMatMul {
    /// The weights, with one row per output.
    pub(crate) rows: Rows,
    pub(crate) inputs: usize,
    /// The zero point of the input.
    pub(crate) zero: i32,
    pub(crate) sums: Sums,
}

impl IntegerMatMul {
    fn multiply<X: Byte, Y: Outcome>(&self, job: Job<'_>) {
        let Job { inputs, form, output, .. } = job;
        let rows = inputs[0].values::<X>();
        let outputs = values_of::<Y>(output, form);
        threads::each_chunk(outputs, self.rows.zeros.len(), &|number, outputs| {
            let input = &rows[number * self.inputs..][..self.inputs];
            let weights = self.rows.values.chunks(self.inputs).zip(&self.rows.zeros);
            for ((channel, output), weights) in outputs.iter_mut().enumerate().zip(weights) {
                let (row, &zero) = weights;
                *output = self.sums.finish(channel, dot(row, zero, input, self.zero));
            }
        });
    }
}

impl Operator for IntegerMatMul {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        along_last(inputs, self.inputs, self.rows.zeros.len())
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        of_bytes(inputs, self.sums.to)
    }

    fn compute(&self, job: Job<'_>) {
        if !job.at.is_empty() {
            typed_byte!(job.inputs[0].form().encoding().element, X => {
                typed!(self.sums.to.element, Y => self.multiply::<X, Y>(job));
            });
        }
    }

    fn products(&self) -> Products {
        Products::Matrix { inputs: self.inputs }
    }

    fn scheduled(&self, at: &Mask) -> usize {
        if at.is_empty() { 0 } else { at.height() * at.width() }
    }

    fn weight_bytes(&self) -> u64 {
        self.rows.bytes() + self.sums.bytes()
    }
}

/// Returns the dot product of a row of weights with the inputs, both less their zero points.
fn dot<X: Byte>(weights: &[i8], weights_zero: i8, inputs: &[X], zero: i32) -> i32 {
    let product = |(&weight, &input): (&i8, &X)| {
        let input: i32 = input.into();
        (i32::from(weight) - i32::from(weights_zero)) * (input - zero)
    };
    weights.iter().zip(inputs).map(product).fold(0, i32::wrapping_add)
}
