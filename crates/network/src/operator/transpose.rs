// SPDX-License-Identifier: MIT OR Apache-2.0
//! The axes in another order.

use super::{Job, Operator, moved, only};
use crate::element::{Encoding, typed};
use crate::form::Form;

#[derive(Clone, Debug)]
pub(crate) struct Transpose {
    /// For each axis of the output, that of the input.
    pub(crate) order: Vec<usize>,
}

impl Operator for Transpose {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let input = only(inputs)?;
        let mut sorted = self.order.clone();
        sorted.sort_unstable();
        if !sorted.into_iter().eq(0..input.shape().len()) {
            return Err(format!(
                "{:?} is not an order of the axes of {}",
                self.order,
                input.describe()
            ));
        }
        let shape = self.order.iter().map(|&axis| input.shape()[axis]).collect();
        let place = |axis| self.order.iter().position(|&from| from == axis);
        let axes = input.axes();
        let start = place(axes.start).filter(|_| input.has_positions());
        // Rows must stay before columns, side by side.
        let together = start.filter(|&start| {
            axes.clone().enumerate().all(|(at, axis)| place(axis) == Some(start + at))
        });
        Ok(match together {
            Some(start) => Form::at(shape, start..start + axes.len()),
            None => Form::whole(shape),
        })
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved(inputs)
    }

    fn compute(&self, job: Job<'_>) {
        let (inputs, form) = (job.inputs, job.form);
        if job.at.is_empty() {
            return;
        }
        let steps = inputs[0].form().steps();
        let steps: Vec<usize> = self.order.iter().map(|&axis| steps[axis]).collect();
        typed!(form.encoding().element, T => job.fill::<T>(|run, to| {
            for (place, to) in run.zip(to) {
                *to = inputs[0].values()[form.offset(place, &steps)];
            }
        }));
    }
}
