// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operators that compute nothing: they give the values of a tensor in another shape
//! ([`Reshape`], [`FeatureView`]), or a constant tensor in the place of an input that depends
//! on the frame ([`ConstantTensor`]).

use super::binary_operator::{aligned_mask, full_if};
use super::{Operator, OperatorJob, ProductKind, moved_encoding, only_input, output_values};
use crate::element::{Encoding, with_element_type};
use crate::mask::Mask;
use crate::tensor::{Tensor, TensorForm, checked_element_count};
use std::ops::Range;

/// The values of a tensor, in the same order, in another shape.
#[derive(Clone, Debug)]
pub(crate) struct Reshape {
    /// The shape as ONNX defines it: 0 is the length of the input's axis, and -1 is the length that
    /// follows from the others.
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
        let (input_width, output_width) = (form.width(), output.width());
        Mask::from_fn(output.height(), output_width, |x, y| {
            let at = y * output_width + x;
            mask.contains(at % input_width, at / input_width)
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
        let misfit_message = || format!("{} cannot become {:?}", input.describe(), self.shape);
        let mut shape = Vec::new();
        let mut inferred_axis = None;
        for (axis, &length) in self.shape.iter().enumerate() {
            shape.push(match length {
                0 => *input.shape().get(axis).ok_or_else(misfit_message)?,
                -1 if inferred_axis.is_none() => {
                    inferred_axis = Some(axis);
                    1
                }
                _ => usize::try_from(length).map_err(|_| misfit_message())?,
            });
        }
        let product = checked_element_count(&shape).ok_or_else(misfit_message)?;
        if let Some(axis) = inferred_axis {
            shape[axis] = input.element_count().checked_div(product).ok_or_else(misfit_message)?;
        }
        if shape.iter().product::<usize>() == input.element_count() {
            Ok(shape)
        } else {
            Err(misfit_message())
        }
    }
}

/// Returns the axes of a new shape that hold all positions of an input. The axes before them must
/// have as many values as in the input. Axes of the same lengths are preferred, then a single axis,
/// then two axes.
fn position_axes_of(input: &TensorForm, shape: &[usize]) -> Option<Range<usize>> {
    let lengths = &input.shape()[input.position_axes()];
    let values_before: usize = input.shape()[..input.position_axes().start].iter().product();
    let find_axes = |count: usize, fits: &dyn Fn(&[usize]) -> bool| {
        let axes = (0..=shape.len().checked_sub(count)?).map(|start| start..start + count);
        let has_same_values_before =
            |axes: &Range<usize>| shape[..axes.start].iter().product::<usize>() == values_before;
        axes.filter(has_same_values_before).find(|axes| fits(&shape[axes.clone()]))
    };
    let holds_all = |axes: &[usize]| axes.iter().product::<usize>() == input.position_count();
    input.has_positions().then_some(())?;
    find_axes(lengths.len(), &|axes| axes == lengths)
        .or_else(|| find_axes(1, &holds_all))
        .or_else(|| find_axes(2, &holds_all))
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

#[derive(Clone, Debug)]
pub(crate) struct ConstantTensor(pub(crate) Tensor);

impl Operator for ConstantTensor {
    fn form(&self, _inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        Ok(self.0.form().clone())
    }

    fn encoding(&self, _inputs: &[Encoding]) -> Result<Encoding, String> {
        Ok(self.0.form().encoding())
    }

    fn spread(&self, _inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        Mask::empty(output.height(), output.width())
    }

    fn products(&self) -> ProductKind {
        ProductKind::NoComputation
    }

    fn compute(&self, job: OperatorJob<'_>) {
        with_element_type!(job.form.encoding().element, T => {
            output_values::<T>(job.output, job.form).copy_from_slice(self.0.values());
        });
    }

    fn weight_bytes(&self) -> u64 {
        self.0.form().bytes()
    }
}
