// SPDX-License-Identifier: MIT OR Apache-2.0
//! The axes that a reduction removes or leaves with length 1.

use super::alignment::aligned_mask;
use super::{OperatorJob, only_input};
use crate::mask::Mask;
use crate::tensor_form::TensorForm;
use crate::values::TensorNumber;

#[derive(Clone, Debug)]
pub(crate) struct ReducedAxes {
    /// The reduced axes in ascending order, each once.
    pub(crate) axes: Vec<usize>,
    /// True if the reduced axes stay in the output with length 1.
    pub(crate) keeps_axes: bool,
}

impl ReducedAxes {
    pub(super) fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let input = only_input(inputs)?;
        if let Some(axis) = self.axes.iter().find(|&&axis| axis >= input.shape().len()) {
            return Err(format!("its input {} has no axis {axis}", input.describe()));
        }
        let left = input.shape().iter().enumerate().filter_map(|(axis, &length)| {
            match (self.axes.contains(&axis), self.keeps_axes) {
                (false, _) => Some(length),
                (true, true) => Some(1),
                (true, false) => None,
            }
        });
        let shape = left.collect();
        let axes: Vec<usize> = input
            .position_axes()
            .filter_map(|axis| self.output_axis(axis, self.keeps_axes))
            .collect();
        Ok(match (axes.first(), axes.last()) {
            (Some(&first), Some(&last)) => TensorForm::with_positions(shape, first..last + 1),
            _ => TensorForm::without_positions(shape),
        })
    }

    /// Returns the axis of the output that an axis of the input becomes. For a reduced axis this is
    /// `None` unless `is_kept`.
    fn output_axis(&self, axis: usize, is_kept: bool) -> Option<usize> {
        let removed_before = self.axes.iter().filter(|&&reduced| reduced < axis).count();
        match (self.axes.contains(&axis), self.keeps_axes) {
            (true, _) => is_kept.then_some(axis),
            (false, true) => Some(axis),
            (false, false) => Some(axis - removed_before),
        }
    }

    pub(super) fn spread(&self, input: (&TensorForm, &Mask), output: &TensorForm) -> Mask {
        aligned_mask(input, output, |axis| self.output_axis(axis, false))
    }

    /// Returns the offsets, from the first value of an output, of the runs of neighboring values
    /// that are reduced, and the length of each run.
    fn run_offsets(&self, form: &TensorForm) -> (Vec<usize>, usize) {
        let (shape, steps) = (form.shape(), form.strides());
        let reduced_at_end =
            (0..shape.len()).rev().take_while(|axis| self.axes.contains(axis)).count();
        let run_axis = shape.len() - reduced_at_end;
        let mut offsets = vec![0];
        for &axis in self.axes.iter().filter(|&&axis| axis < run_axis) {
            let along = |offset: usize| (0..shape[axis]).map(move |at| (offset, at));
            offsets = offsets
                .into_iter()
                .flat_map(along)
                .map(|(offset, at)| offset + at * steps[axis])
                .collect();
        }
        (offsets, shape[run_axis..].iter().product())
    }

    /// Fills every output. `reduce` gets the values of an output as runs in the order of memory.
    pub(super) fn fill<Y: TensorNumber>(
        &self,
        job: OperatorJob<'_>,
        reduce: impl Fn(&mut dyn Iterator<Item = &[f32]>) -> Y + Sync,
    ) {
        let (values, input) = (job.inputs[0].values::<f32>(), job.inputs[0].form());
        let (offsets, run_length) = self.run_offsets(input);
        // This form has the shape of the output with all reduced axes, each with length 1.
        let steps = input.strides();
        let whole = (0..input.shape().len()).map(|axis| match self.axes.contains(&axis) {
            true => (1, 0),
            false => (input.shape()[axis], steps[axis]),
        });
        let (shape, steps): (Vec<usize>, Vec<usize>) = whole.unzip();
        let form = TensorForm::without_positions(shape);
        job.fill::<Y>(|run, to| {
            for (place, to) in run.zip(to) {
                let first = form.offset(place, &steps);
                *to = reduce(
                    &mut offsets.iter().map(|offset| &values[first + offset..][..run_length]),
                );
            }
        });
    }
}
