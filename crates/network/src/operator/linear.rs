// SPDX-License-Identifier: MIT OR Apache-2.0
//! Products with a matrix: fully connected layers.

use super::{Job, Operator, Products, everything, only, values_of};
use crate::form::Form;
use crate::mask::Mask;
use rayon::prelude::*;

/// Partial sums of a dot product, added at the end in one order.
const PARTS: usize = 16;

/// A fully connected layer: every output is a sum over the whole input.
#[derive(Clone, Debug)]
pub(crate) struct Linear {
    /// A row per output.
    weights: Vec<f32>,
    bias: Vec<f32>,
    inputs: usize,
}

impl Linear {
    /// `alpha * (weights of inputs x outputs, or of outputs x inputs if `transposed`) * input + beta * bias`.
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
        Ok(Self { weights: (0..outputs).flat_map(row).collect(), bias, inputs })
    }
}

impl Operator for Linear {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let form = only(inputs)?;
        match *form.shape() {
            [1, length] if length == self.inputs => Ok(Form::whole(vec![1, self.bias.len()])),
            _ => Err(format!("it takes [1, {}], not {}", self.inputs, form.describe())),
        }
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        everything(inputs, output)
    }

    fn compute(&self, job: Job<'_>) {
        if job.at.is_empty() {
            return;
        }
        let input = job.inputs[0].values::<f32>();
        let outputs = values_of::<f32>(job.output, job.form).par_iter_mut().zip(&self.bias);
        let rows = self.weights.par_chunks(self.inputs);
        outputs.zip(rows).for_each(|((output, bias), row)| *output = bias + dot(row, input));
    }

    fn products(&self) -> Products {
        Products::Matrix { inputs: self.inputs }
    }

    fn weight_bytes(&self) -> u64 {
        4 * (self.weights.len() + self.bias.len()) as u64
    }
}

/// The sum of all products, always in the same order.
fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut parts = [0.0f32; PARTS];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<PARTS>(), b.as_chunks::<PARTS>());
    for (a, b) in a.iter().zip(b) {
        for part in 0..PARTS {
            parts[part] += a[part] * b[part];
        }
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    parts.iter().sum::<f32>() + rest
}

/// The form of the product of the last axis with a matrix.
pub(super) fn along_last(inputs: &[&Form], own: usize, outputs: usize) -> Result<Form, String> {
    let form = only(inputs)?;
    let mut shape = form.shape().to_vec();
    match shape.last_mut() {
        Some(last) if *last == own => *last = outputs,
        _ => return Err(format!("its matrix takes {own} values, not {}", form.describe())),
    }
    // Rows that are positions stay what they are.
    let last = shape.len() - 1;
    Ok(if form.has_positions() && form.axes().end <= last {
        Form::at(shape, form.axes())
    } else {
        Form::whole(shape)
    })
}

/// The product of the last axis with a constant matrix.
#[derive(Clone, Debug)]
pub(crate) struct MatMul {
    /// A row per output.
    weights: Vec<f32>,
    inputs: usize,
}

impl MatMul {
    /// With a constant of `inputs` x `outputs` values.
    pub(crate) fn new(shape: &[usize], weights: &[f32]) -> Result<Self, String> {
        let &[inputs, outputs] = shape else {
            return Err(format!("its matrix has {} axes, not 2", shape.len()));
        };
        let row = |output| (0..inputs).map(move |input| weights[input * outputs + output]);
        Ok(Self { weights: (0..outputs).flat_map(row).collect(), inputs })
    }

    fn outputs(&self) -> usize {
        self.weights.len() / self.inputs
    }
}

impl Operator for MatMul {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        along_last(inputs, self.inputs, self.outputs())
    }

    fn compute(&self, job: Job<'_>) {
        let Job { inputs, form, output, at } = job;
        if at.is_empty() {
            return;
        }
        let outputs = self.outputs();
        let rows = inputs[0].values::<f32>().par_chunks(self.inputs);
        values_of::<f32>(output, form).par_chunks_mut(outputs).zip(rows).for_each(
            |(outputs, input)| {
                let weights = self.weights.chunks(self.inputs);
                outputs.iter_mut().zip(weights).for_each(|(output, row)| *output = dot(row, input));
            },
        );
    }

    fn products(&self) -> Products {
        Products::Matrix { inputs: self.inputs }
    }

    fn scheduled(&self, at: &Mask) -> usize {
        if at.is_empty() { 0 } else { at.height() * at.width() }
    }

    fn weight_bytes(&self) -> u64 {
        4 * self.weights.len() as u64
    }
}
