// SPDX-License-Identifier: MIT OR Apache-2.0
//! The product of the last axis of 8-bit values with a constant matrix of 8-bit values, as in fully
//! connected layers.

use super::integer_conv::ByteWeightRows;
use super::linear::matrix_product_form;
use super::requantization::{Requantization, SumOutput};
use super::{Operator, OperatorJob, ProductKind, encoding_from_bytes, output_values};
use crate::element::{Encoding, with_byte_type, with_element_type};
use crate::mask::Mask;
use crate::tensor_form::TensorForm;
use crate::threads;
use crate::values::ByteNumber;

#[derive(Clone, Debug)]
pub(crate) struct IntegerMatMul {
    /// The weights, with one row per output.
    pub(crate) rows: ByteWeightRows,
    pub(crate) inputs: usize,
    /// The zero point of the input.
    pub(crate) zero_point: i32,
    pub(crate) sums: Requantization,
}

impl IntegerMatMul {
    fn multiply<X: ByteNumber, Y: SumOutput>(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, .. } = job;
        let rows = inputs[0].values::<X>();
        let outputs = output_values::<Y>(output, form);
        threads::for_each_chunk(outputs, self.rows.zero_points.len(), &|number, outputs| {
            let input = &rows[number * self.inputs..][..self.inputs];
            let weights = self.rows.values.chunks(self.inputs).zip(&self.rows.zero_points);
            for ((channel, output), weights) in outputs.iter_mut().enumerate().zip(weights) {
                let (row, &zero) = weights;
                *output = self.sums.requantize(channel, dot(row, zero, input, self.zero_point));
            }
        });
    }
}

impl Operator for IntegerMatMul {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        matrix_product_form(inputs, self.inputs, self.rows.zero_points.len())
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        encoding_from_bytes(inputs, self.sums.to)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        if !job.positions.is_empty() {
            with_byte_type!(job.inputs[0].form().encoding().element, X => {
                with_element_type!(self.sums.to.element, Y => self.multiply::<X, Y>(job));
            });
        }
    }

    fn products(&self) -> ProductKind {
        ProductKind::Matrix { inputs: self.inputs }
    }

    fn scheduled_positions(&self, at: &Mask) -> usize {
        if at.is_empty() { 0 } else { at.height() * at.width() }
    }

    fn weight_bytes(&self) -> u64 {
        self.rows.byte_count() + self.sums.bytes()
    }
}

/// Returns the dot product of a row of weights with the inputs, both less their zero points.
fn dot<X: ByteNumber>(weights: &[i8], weights_zero: i8, inputs: &[X], zero: i32) -> i32 {
    let product = |(&weight, &input): (&i8, &X)| {
        let input: i32 = input.into();
        (i32::from(weight) - i32::from(weights_zero)) * (input - zero)
    };
    weights.iter().zip(inputs).map(product).fold(0, i32::wrapping_add)
}
