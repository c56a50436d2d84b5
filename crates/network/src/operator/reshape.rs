// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reshaping: the values of a tensor in another shape.

use super::alignment::{aligned_mask, full_if};
use super::{Operator, OperatorJob, ProductKind, moved_encoding, only_input};
use crate::element::{Encoding, with_element_type};
use crate::mask::Mask;
use crate::tensor_form::{TensorForm, checked_element_count};
use std::ops::Range;

/// The values of a tensor, in the same order, in another shape.
#[derive(Clone, Debug)]
pub(crate) struct Reshape {
    /// The shape as ONNX defines it: 0 is the length of the input's axis, and -1 is the length that
    /// is left.
    pub(crate) shape: Vec<i64>,
}

impl Operator for Reshape {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let input = only_input(inputs)?;
        let shape = self.resolve(input)?;
        let axes = position_axes_of(input, &shape);
        Ok(axes.map_or_else(
            || TensorForm::without_positions(shape.clone()),
            |axes| TensorForm::with_positions(shape.clone(), axes),
        ))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved_encoding(inputs)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let (form, mask) = inputs[0];
        if !output.has_positions() {
            return full_if(!mask.is_empty(), output);
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

    fn products(&self) -> ProductKind {
        ProductKind::NoComputation
    }

    fn compute(&self, job: OperatorJob<'_>) {
        copy_input(job);
    }
}

impl Reshape {
    fn resolve(&self, input: &TensorForm) -> Result<Vec<usize>, String> {
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
        let product = checked_element_count(&shape).ok_or_else(wrong)?;
        if let Some(axis) = open {
            shape[axis] = input.element_count().checked_div(product).ok_or_else(wrong)?;
        }
        if shape.iter().product::<usize>() == input.element_count() {
            Ok(shape)
        } else {
            Err(wrong())
        }
    }
}

/// Returns the axes that hold all positions of an input behind the same number of values as before:
/// first the same lengths, otherwise one axis, otherwise two axes.
fn position_axes_of(input: &TensorForm, shape: &[usize]) -> Option<Range<usize>> {
    let own = &input.shape()[input.position_axes()];
    let before: usize = input.shape()[..input.position_axes().start].iter().product();
    let find = |count: usize, is: &dyn Fn(&[usize]) -> bool| {
        let axes = (0..=shape.len().checked_sub(count)?).map(|start| start..start + count);
        let stands = |axes: &Range<usize>| shape[..axes.start].iter().product::<usize>() == before;
        axes.filter(stands).find(|axes| is(&shape[axes.clone()]))
    };
    let holds_all = |axes: &[usize]| axes.iter().product::<usize>() == input.position_count();
    input.has_positions().then_some(())?;
    find(own.len(), &|axes| axes == own)
        .or_else(|| find(1, &holds_all))
        .or_else(|| find(2, &holds_all))
}

/// A tensor of four axes as features, for an operator that sees rows and columns.
#[derive(Clone, Debug)]
pub(crate) struct FeatureView;

impl FeatureView {
    /// The axes that are rows and columns of features.
    const AXES: Range<usize> = 2..4;

    /// Returns true if a tensor of this form must become features first.
    pub(crate) fn applies_to(form: &TensorForm) -> bool {
        form.shape().len() == 4 && form.shape()[0] == 1 && form.position_axes() != Self::AXES
    }
}

impl Operator for FeatureView {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        Ok(TensorForm::with_positions(only_input(inputs)?.shape().to_vec(), Self::AXES))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved_encoding(inputs)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        aligned_mask(inputs[0], output, Some)
    }

    fn products(&self) -> ProductKind {
        ProductKind::NoComputation
    }

    fn compute(&self, job: OperatorJob<'_>) {
        copy_input(job);
    }
}

/// Copies the values of the input to the same memory indices of the output.
fn copy_input(job: OperatorJob<'_>) {
    let inputs = job.inputs;
    with_element_type!(job.form.encoding().element, T => {
        job.fill::<T>(|run, to| to.copy_from_slice(&inputs[0].values()[run]));
    });
}
