// SPDX-License-Identifier: MIT OR Apache-2.0
//! A part of a tensor.

use super::{Job, Operator, only};
use crate::form::Form;
use crate::mask::Mask;

/// Every so many elements of an axis, from a first one to before a last one.
#[derive(Clone, Debug)]
pub(crate) struct Slice {
    pub(crate) axis: i64,
    /// Negative from the end on, and cut off where the axis ends.
    pub(crate) start: i64,
    pub(crate) end: i64,
    pub(crate) step: usize,
}

impl Slice {
    /// The axis, the first element, and how many there are.
    fn range(&self, form: &Form) -> Result<(usize, usize, usize), String> {
        let axis = form.axis(self.axis)?;
        let length = i64::try_from(form.shape()[axis]).map_err(|_| "an axis is too long")?;
        let place =
            |at: i64| if at < 0 { at.saturating_add(length).max(0) } else { at.min(length) };
        let (start, end) = (place(self.start), place(self.end));
        let count = usize::try_from(end - start).unwrap_or(0).div_ceil(self.step);
        if count == 0 {
            return Err(format!("{}..{} of {length} elements is empty", self.start, self.end));
        }
        Ok((axis, usize::try_from(start).expect("not negative"), count))
    }
}

impl Operator for Slice {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let input = only(inputs)?;
        let (axis, _, count) = self.range(input)?;
        let mut shape = input.shape().to_vec();
        shape[axis] = count;
        Ok(Form::at(shape, input.axes()))
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        let (form, mask) = inputs[0];
        let (axis, start, _) = self.range(form).expect("the form has it");
        let along = |of: usize| (axis == of).then_some((start, self.step));
        let columns = form.has_positions().then(|| along(form.axes().end - 1)).flatten();
        let rows = (form.axes().len() == 2).then(|| along(form.axes().start)).flatten();
        if rows.is_none() && columns.is_none() {
            return mask.clone();
        }
        let sees = |range: Option<(usize, usize)>, count: usize| -> Vec<(usize, usize)> {
            let (start, step) = range.unwrap_or((0, 1));
            (0..count).map(|at| (start + at * step, start + at * step)).collect()
        };
        mask.between(&sees(rows, output.height()), &sees(columns, output.width()))
    }

    fn compute(&self, job: Job<'_>) {
        let Job { inputs, form, output, at, .. } = job;
        let (axis, start, count) = self.range(inputs[0].form()).expect("the form has it");
        let behind: usize = form.shape()[axis + 1..].iter().product();
        let all = inputs[0].form().shape()[axis];
        crate::tensor::for_each_run(form, at, |run| {
            for (place, to) in run.clone().zip(&mut output[run]) {
                let (before, index, after) =
                    (place / behind / count, place / behind % count, place % behind);
                *to =
                    inputs[0].values()[(before * all + start + index * self.step) * behind + after];
            }
        });
    }
}
