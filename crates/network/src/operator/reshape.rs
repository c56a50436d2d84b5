// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reshaping: the values of a tensor in another shape.

use super::places::{aligned, all_if};
use super::{Job, Operator, Products, moved, only};
use crate::element::{Encoding, typed};
use crate::form::{Form, elements_of};
use crate::mask::Mask;
use std::ops::Range;

/// The values of a tensor, in the same order, in another shape.
#[derive(Clone, Debug)]
pub(crate) struct Reshape {
    /// The shape as ONNX defines it: 0 is the length of the input's axis, and -1 is the length that
    /// is left.
    pub(crate) shape: Vec<i64>,
}

impl Operator for Reshape {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let input = only(inputs)?;
        let shape = self.resolve(input)?;
        let axes = positions(input, &shape);
        Ok(axes.map_or_else(|| Form::whole(shape.clone()), |axes| Form::at(shape.clone(), axes)))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved(inputs)
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        let (form, mask) = inputs[0];
        if !output.has_positions() {
            return all_if(!mask.is_empty(), output);
        }
        if (form.height(), form.width()) == (output.height(), output.width()) {
            return mask.clone();
        }
        // Positions have the same order in memory before and after.
        let (own, new) = (form.width(), output.width());
        Mask::from_fn(output.height(), new, |x, y| {
            let at = y * new + x;
            mask.contains(at % own, at / own)
        })
    }

    fn products(&self) -> Products {
        Products::Renamed
    }

    fn compute(&self, job: Job<'_>) {
        copy(job);
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
        let product = elements_of(&shape).ok_or_else(wrong)?;
        if let Some(axis) = open {
            shape[axis] = input.elements().checked_div(product).ok_or_else(wrong)?;
        }
        if shape.iter().product::<usize>() == input.elements() { Ok(shape) } else { Err(wrong()) }
    }
}

/// Returns the axes that hold all positions of an input behind the same number of values as before:
/// first the same lengths, otherwise one axis, otherwise two axes.
fn positions(input: &Form, shape: &[usize]) -> Option<Range<usize>> {
    let own = &input.shape()[input.axes()];
    let before: usize = input.shape()[..input.axes().start].iter().product();
    let find = |count: usize, is: &dyn Fn(&[usize]) -> bool| {
        let axes = (0..=shape.len().checked_sub(count)?).map(|start| start..start + count);
        let stands = |axes: &Range<usize>| shape[..axes.start].iter().product::<usize>() == before;
        axes.filter(stands).find(|axes| is(&shape[axes.clone()]))
    };
    let holds_all = |axes: &[usize]| axes.iter().product::<usize>() == input.places();
    input.has_positions().then_some(())?;
    find(own.len(), &|axes| axes == own)
        .or_else(|| find(1, &holds_all))
        .or_else(|| find(2, &holds_all))
}

/// A tensor of four axes as features, for an operator that sees rows and columns.
#[derive(Clone, Debug)]
pub(crate) struct Placed;

impl Placed {
    /// The axes that are rows and columns of features.
    const AXES: Range<usize> = 2..4;

    /// Returns true if a tensor of this form must become features first.
    pub(crate) fn takes(form: &Form) -> bool {
        form.shape().len() == 4 && form.shape()[0] == 1 && form.axes() != Self::AXES
    }
}

impl Operator for Placed {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        Ok(Form::at(only(inputs)?.shape().to_vec(), Self::AXES))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved(inputs)
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        aligned(inputs[0], output, Some)
    }

    fn products(&self) -> Products {
        Products::Renamed
    }

    fn compute(&self, job: Job<'_>) {
        copy(job);
    }
}

/// Copies the values of the input to the same memory indices of the output.
fn copy(job: Job<'_>) {
    let inputs = job.inputs;
    typed!(job.form.encoding().element, T => {
        job.fill::<T>(|run, to| to.copy_from_slice(&inputs[0].values()[run]));
    });
}
