// SPDX-License-Identifier: MIT OR Apache-2.0
//! Products with a constant matrix, as in fully connected layers.

use super::{Operator, OperatorJob, ProductKind, only_input, output_values};
use crate::mask::Mask;
use crate::tensor_form::TensorForm;
use crate::threads;

/// The number of partial sums of a dot product. They are added at the end, in a fixed order.
const PARTIAL_SUMS: usize = 16;

/// Returns the dot product of two rows, always summed in the same order.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut parts = [0.0f32; PARTIAL_SUMS];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<PARTIAL_SUMS>(), b.as_chunks::<PARTIAL_SUMS>());
    for (a, b) in a.iter().zip(b) {
        for part in 0..PARTIAL_SUMS {
            parts[part] += a[part] * b[part];
        }
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    parts.iter().sum::<f32>() + rest
}

/// Returns the form of the product of the last axis with a matrix of `inner` x `outputs` values.
pub(super) fn matrix_product_form(
    inputs: &[&TensorForm],
    inner: usize,
    outputs: usize,
) -> Result<TensorForm, String> {
    let form = only_input(inputs)?;
    let mut shape = form.shape().to_vec();
    match shape.last_mut() {
        Some(last) if *last == inner => *last = outputs,
        _ => return Err(format!("its matrix takes {inner} values, not {}", form.describe())),
    }
    // Positions before the last axis remain positions.
    let last = shape.len() - 1;
    Ok(if form.has_positions() && form.position_axes().end <= last {
        TensorForm::with_positions(shape, form.position_axes())
    } else {
        TensorForm::without_positions(shape)
    })
}

/// The product of the last axis with a constant matrix, plus a bias.
#[derive(Clone, Debug)]
pub(crate) struct Linear {
    /// The weights, with one row per output.
    weights: Vec<f32>,
    /// The bias: one value per output, or empty.
    bias: Vec<f32>,
    inputs: usize,
    /// True if the input must have two axes.
    needs_two_axes: bool,
}

impl Linear {
    /// Returns the product with a constant of `inputs` x `outputs` values, without a bias.
    pub(crate) fn from_matrix(shape: &[usize], weights: &[f32]) -> Result<Self, String> {
        let linear = Self::new(shape, weights, None, false, 1.0, 1.0)?;
        Ok(Self { bias: Vec::new(), needs_two_axes: false, ..linear })
    }

    /// Returns `alpha * weights * input + beta * bias`. The weights are `inputs` x `outputs`
    /// values, or `outputs` x `inputs` if `transposed`.
    pub(crate) fn new(
        shape: &[usize],
        weights: &[f32],
        bias: Option<&[f32]>,
        transposed: bool,
        alpha: f32,
        beta: f32,
    ) -> Result<Self, String> {
        let &[rows, columns] = shape else {
            return Err(format!("its weights have {} axes, not 2", shape.len()));
        };
        let (outputs, inputs) = if transposed { (rows, columns) } else { (columns, rows) };
        let at = |output: usize, input: usize| {
            if transposed { output * inputs + input } else { input * outputs + output }
        };
        let row = |output| (0..inputs).map(move |input| alpha * weights[at(output, input)]);
        let bias = match bias {
            None => vec![0.0; outputs],
            Some(&[one]) => vec![beta * one; outputs],
            Some(bias) if bias.len() == outputs => bias.iter().map(|bias| beta * bias).collect(),
            Some(bias) => {
                return Err(format!("its bias has {} values for {outputs} outputs", bias.len()));
            }
        };
        Ok(Self {
            weights: (0..outputs).flat_map(row).collect(),
            bias,
            inputs,
            needs_two_axes: true,
        })
    }

    fn outputs(&self) -> usize {
        self.weights.len() / self.inputs
    }
}

impl Operator for Linear {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let form = only_input(inputs)?;
        if self.needs_two_axes && form.shape().len() != 2 {
            return Err(format!("it takes [rows, {}], not {}", self.inputs, form.describe()));
        }
        matrix_product_form(inputs, self.inputs, self.outputs())
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, positions: at } = job;
        if at.is_empty() {
            return;
        }
        let (outputs, input) = (self.outputs(), inputs[0].values::<f32>());
        threads::for_each_chunk(output_values::<f32>(output, form), 1, &|place, output| {
            let (row, column) = (place / outputs, place % outputs);
            let bias = self.bias.get(column).copied().unwrap_or(0.0);
            let weights = &self.weights[column * self.inputs..][..self.inputs];
            output[0] = bias + dot(weights, &input[row * self.inputs..][..self.inputs]);
        });
    }

    fn products(&self) -> ProductKind {
        ProductKind::Matrix { inputs: self.inputs }
    }

    fn scheduled_positions(&self, at: &Mask) -> usize {
        if at.is_empty() { 0 } else { at.height() * at.width() }
    }

    fn weight_bytes(&self) -> u64 {
        4 * (self.weights.len() + self.bias.len()) as u64
    }
}
