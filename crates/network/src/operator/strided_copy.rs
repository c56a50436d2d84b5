// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tensors that read an input with other strides: transposed or broadcast.

use super::binary_operator::aligned_mask;
use super::{Operator, OperatorJob, moved_encoding, only_input};
use crate::element::{Encoding, with_element_type};
use crate::mask::Mask;
use crate::tensor::TensorForm;
use crate::values::TensorNumber;

/// Fills the output with values of the input at these strides, one for each axis of the output.
fn copy_strided<T: TensorNumber>(job: OperatorJob<'_>, steps: &[usize]) {
    let (values, form) = (job.inputs[0].values::<T>(), job.form);
    let line = form.shape().last().copied().unwrap_or(1);
    let step = steps.last().copied().unwrap_or(0);
    job.fill::<T>(|run, to| {
        let (mut start, mut to) = (run.start, to);
        while !to.is_empty() {
            let (part, rest) = to.split_at_mut(to.len().min(line - start % line));
            let from = &values[form.offset(start, steps)..];
            match step {
                0 => part.fill(from[0]),
                1 => part.copy_from_slice(&from[..part.len()]),
                _ => {
                    let from = from.iter().step_by(step);
                    part.iter_mut().zip(from).for_each(|(to, &from)| *to = from);
                }
            }
            start += part.len();
            to = rest;
        }
    });
}

/// A permutation of the axes.
#[derive(Clone, Debug)]
pub(crate) struct Transpose {
    /// The axis of the input for each axis of the output.
    pub(crate) order: Vec<usize>,
}

impl Transpose {
    /// Returns the axis of the output that an axis of the input becomes.
    fn output_axis(&self, axis: usize) -> Option<usize> {
        self.order.iter().position(|&from| from == axis)
    }
}

impl Operator for Transpose {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let input = only_input(inputs)?;
        let mut sorted = self.order.clone();
        sorted.sort_unstable();
        if !sorted.into_iter().eq(0..input.shape().len()) {
            return Err(format!(
                "{:?} is not an order of the axes of {}",
                self.order,
                input.describe()
            ));
        }
        let shape: Vec<usize> = self.order.iter().map(|&axis| input.shape()[axis]).collect();
        let mut places: Vec<usize> =
            input.position_axes().filter_map(|axis| self.output_axis(axis)).collect();
        places.sort_unstable();
        Ok(match *places.as_slice() {
            [first, second] if first + 1 == second => {
                TensorForm::with_positions(shape, first..first + 2)
            }
            // If the axes of positions become separated, only the longer one remains an axis of
            // positions.
            [first, second] => {
                let longest = if shape[first] > shape[second] { first } else { second };
                TensorForm::with_positions(shape, longest..longest + 1)
            }
            [only] => TensorForm::with_positions(shape, only..only + 1),
            _ => TensorForm::without_positions(shape),
        })
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved_encoding(inputs)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        aligned_mask(inputs[0], output, |axis| self.output_axis(axis))
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let steps = job.inputs[0].form().strides();
        let steps: Vec<usize> = self.order.iter().map(|&axis| steps[axis]).collect();
        with_element_type!(job.form.encoding().element, T => copy_strided::<T>(job, &steps));
    }
}

/// A tensor that is broadcast: repeated along axes of one element, and along new axes in front.
#[derive(Clone, Debug)]
pub(crate) struct Expand {
    pub(crate) shape: Vec<usize>,
}

impl Operator for Expand {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let input = only_input(inputs)?;
        let new_axes = self.shape.len().checked_sub(input.shape().len());
        let fits = |new_axes: usize| {
            let lengths = input.shape().iter().zip(&self.shape[new_axes..]);
            lengths.into_iter().all(|(&length, &wanted)| length == wanted || length == 1)
        };
        let Some(new_axes) = new_axes.filter(|&new_axes| fits(new_axes)) else {
            return Err(format!("{} cannot become {:?}", input.describe(), self.shape));
        };
        let axes = input.position_axes().start + new_axes..input.position_axes().end + new_axes;
        let is_kept = axes.clone().all(|axis| self.shape[axis] == input.shape()[axis - new_axes]);
        Ok(if is_kept && input.has_positions() {
            TensorForm::with_positions(self.shape.clone(), axes)
        } else {
            TensorForm::without_positions(self.shape.clone())
        })
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved_encoding(inputs)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let new_axes = output.shape().len() - inputs[0].0.shape().len();
        aligned_mask(inputs[0], output, |axis| Some(axis + new_axes))
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let steps = job.form.broadcast_strides(job.inputs[0].form());
        with_element_type!(job.form.encoding().element, T => copy_strided::<T>(job, &steps));
    }
}
