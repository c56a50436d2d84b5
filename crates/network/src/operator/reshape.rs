// SPDX-License-Identifier: MIT OR Apache-2.0
//! The same values in another shape.

use super::{Job, Operator, Products, moved, only, same_position};
use crate::element::{Encoding, typed};
use crate::form::Form;
use crate::mask::Mask;

/// The same values, in the same order, in another shape.
#[derive(Clone, Debug)]
pub(crate) struct Reshape {
    /// As ONNX says it: 0 for the input's own length, -1 for what is left.
    pub(crate) shape: Vec<i64>,
}

impl Operator for Reshape {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let input = only(inputs)?;
        let shape = self.resolve(input)?;
        // Positions stay where their axes stand again behind as many values as before.
        let axes = input.axes();
        let before: usize = input.shape()[..axes.start].iter().product();
        let found = (0..=shape.len()).find(|&start| {
            let own = shape.get(start..start + axes.len());
            own == Some(&input.shape()[axes.clone()])
                && shape[..start].iter().product::<usize>() == before
        });
        let flat = (0..shape.len()).find(|&start| {
            shape[start] == input.places() && shape[..start].iter().product::<usize>() == before
        });
        Ok(match (input.has_positions(), found, flat) {
            (true, Some(start), _) => Form::at(shape, start..start + axes.len()),
            (true, None, Some(start)) => Form::at(shape, start..start + 1),
            _ => Form::whole(shape),
        })
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved(inputs)
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        let (form, mask) = inputs[0];
        if output.has_positions() && output.height() != form.height() {
            // Rows have become one.
            let width = form.width();
            return Mask::from_fn(1, output.width(), |x, _| mask.contains(x % width, x / width));
        }
        same_position(inputs, output)
    }

    fn products(&self) -> Products {
        Products::Renamed
    }

    fn compute(&self, job: Job<'_>) {
        let inputs = job.inputs;
        typed!(job.form.encoding().element, T => {
            job.fill::<T>(|run, to| to.copy_from_slice(&inputs[0].values()[run]));
        });
    }
}

impl Reshape {
    fn resolve(&self, input: &Form) -> Result<Vec<usize>, String> {
        let wrong = || format!("{} cannot become {:?}", input.describe(), self.shape);
        let mut shape = Vec::new();
        let mut open = None;
        for (axis, &length) in self.shape.iter().enumerate() {
            shape.push(match length {
                0 => *input.shape().get(axis).ok_or_else(wrong)?,
                -1 if open.is_none() => {
                    open = Some(axis);
                    1
                }
                _ => usize::try_from(length).map_err(|_| wrong())?,
            });
        }
        let product = shape
            .iter()
            .try_fold(1usize, |product, &length| product.checked_mul(length))
            .ok_or_else(wrong)?;
        if let Some(axis) = open {
            shape[axis] = input.elements().checked_div(product).ok_or_else(wrong)?;
        }
        if shape.iter().product::<usize>() == input.elements() { Ok(shape) } else { Err(wrong()) }
    }
}
