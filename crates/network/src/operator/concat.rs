// SPDX-License-Identifier: MIT OR Apache-2.0
//! Concatenation of tensors along an axis.

use super::alignment::aligned_mask;
use super::binary_operator::broadcast_mask;
use super::{Operator, OperatorJob, moved_encoding};
use crate::element::{Encoding, with_element_type};
use crate::mask::Mask;
use crate::tensor_form::TensorForm;
use crate::values::TensorNumber;

#[derive(Clone, Debug)]
pub(crate) struct Concat {
    /// The axis; a negative number counts from the end.
    pub(crate) axis: i64,
}

impl Operator for Concat {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let first = *inputs.first().ok_or("it has no inputs")?;
        let axis = first.resolve_axis(self.axis)?;
        let mut shape = first.shape().to_vec();
        for form in &inputs[1..] {
            let fits = form.shape().len() == shape.len()
                && (0..shape.len()).all(|at| at == axis || form.shape()[at] == shape[at]);
            if !fits {
                return Err(format!(
                    "{} and {} do not fit together along axis {axis}",
                    first.describe(),
                    form.describe()
                ));
            }
            shape[axis] += form.shape()[axis];
        }
        // The positions of the output are the axes that are positions in all inputs that have
        // positions.
        let positions =
            inputs.iter().map(|form| form.position_axes()).filter(|axes| !axes.is_empty());
        let common = positions.reduce(|a, b| a.start.max(b.start)..a.end.min(b.end));
        Ok(match common.filter(|axes| !axes.is_empty()) {
            Some(axes) => TensorForm::with_positions(shape, axes),
            None => TensorForm::without_positions(shape),
        })
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved_encoding(inputs)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let axis = output.resolve_axis(self.axis).expect("the form has it");
        if !output.position_axes().contains(&axis) {
            return broadcast_mask(inputs, output);
        }
        let is_column = axis + 1 == output.position_axes().end;
        let mut dependent = Mask::empty(output.height(), output.width());
        let mut first = 0;
        for &(form, mask) in inputs {
            let aligned_form =
                TensorForm::with_positions(form.shape().to_vec(), output.position_axes());
            let mask = aligned_mask((form, mask), &aligned_form, Some);
            let (left, top) = if is_column { (first, 0) } else { (0, first) };
            for y in 0..mask.height() {
                for (x, length) in mask.runs(y) {
                    (x..x + length).for_each(|x| dependent.insert(left + x, top + y));
                }
            }
            first += form.shape()[axis];
        }
        dependent
    }

    fn compute(&self, job: OperatorJob<'_>) {
        with_element_type!(job.form.encoding().element, T => {
            self.copy_inputs(job, |_, from: &[T], to: &mut [T]| to.copy_from_slice(from));
        });
    }
}

impl Concat {
    /// Copies the values of every input to their place in the output. `copy` takes the number of
    /// the input.
    pub(super) fn copy_inputs<T: TensorNumber, Y: TensorNumber>(
        &self,
        job: OperatorJob<'_>,
        copy: impl Fn(usize, &[T], &mut [Y]) + Sync,
    ) {
        let (inputs, form) = (job.inputs, job.form);
        let axis = form.resolve_axis(self.axis).expect("the form has it");
        let values_from_axis = |form: &TensorForm| form.shape()[axis..].iter().product::<usize>();
        let line_values = values_from_axis(form);
        // The end of each input in a line of the output.
        let ends: Vec<usize> = inputs
            .iter()
            .scan(0, |end, input| {
                *end += values_from_axis(input.form());
                Some(*end)
            })
            .collect();
        job.fill::<Y>(|run, to| {
            let (mut start, mut to) = (run.start, to);
            while !to.is_empty() {
                let (line, inside) = (start / line_values, start % line_values);
                let number = ends.partition_point(|&end| end <= inside);
                let first = number.checked_sub(1).map_or(0, |before| ends[before]);
                let (part, rest) = to.split_at_mut(to.len().min(ends[number] - inside));
                let from = line * (ends[number] - first) + inside - first;
                copy(number, &inputs[number].values()[from..from + part.len()], part);
                start += part.len();
                to = rest;
            }
        });
    }
}
