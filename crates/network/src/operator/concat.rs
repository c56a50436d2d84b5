// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tensors one behind the other, along an axis.

use super::{Job, Operator, everything, moved, same_position, values_of};
use crate::element::{Encoding, typed};
use crate::form::Form;
use crate::mask::Mask;
use crate::values::Number;

#[derive(Clone, Debug)]
pub(crate) struct Concat {
    /// Negative from the last axis on.
    pub(crate) axis: i64,
}

impl Operator for Concat {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let first = *inputs.first().ok_or("it has no inputs")?;
        let axis = first.axis(self.axis)?;
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
        let alike = inputs.iter().all(|form| form.axes() == first.axes());
        Ok(if alike && !first.axes().contains(&axis) {
            Form::at(shape, first.axes())
        } else {
            Form::whole(shape)
        })
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved(inputs)
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        if output.has_positions() {
            same_position(inputs, output)
        } else {
            everything(inputs, output)
        }
    }

    fn compute(&self, job: Job<'_>) {
        typed!(job.form.encoding().element, T => {
            self.join(job, |_, from: &[T], to: &mut [T]| to.copy_from_slice(from));
        });
    }
}

impl Concat {
    /// Makes the values of every input, by its number, those of the output where they stand.
    pub(super) fn join<T: Number, Y: Number>(
        &self,
        job: Job<'_>,
        copy: impl Fn(usize, &[T], &mut [Y]),
    ) {
        let Job { inputs, form, output, at, .. } = job;
        let output: &mut [Y] = values_of(output, form);
        let axis = form.axis(self.axis).expect("the form has it");
        let behind = |form: &Form| form.shape()[axis..].iter().product::<usize>();
        let whole = behind(form);
        let mut offset = 0;
        for (number, input) in inputs.iter().enumerate() {
            let own = behind(input.form());
            if form.has_positions() {
                // Positions are inside what is joined, or outside of it: a run stays a run.
                crate::tensor::for_each_run(input.form(), at, |run| {
                    for from in Lines::of(run, own) {
                        let to = from.start / own * whole + offset + from.start % own;
                        copy(
                            number,
                            &input.values()[from.clone()],
                            &mut output[to..to + from.len()],
                        );
                    }
                });
            } else if !at.is_empty() {
                let lines = output.chunks_mut(whole).zip(input.values().chunks(own));
                lines.for_each(|(to, from)| copy(number, from, &mut to[offset..offset + own]));
            }
            offset += own;
        }
    }
}

/// A range cut where multiples of a length are.
struct Lines {
    rest: std::ops::Range<usize>,
    length: usize,
}

impl Lines {
    fn of(rest: std::ops::Range<usize>, length: usize) -> Self {
        Self { rest, length }
    }
}

impl Iterator for Lines {
    type Item = std::ops::Range<usize>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let start = self.rest.start;
        self.rest.start = self.rest.end.min((start / self.length + 1) * self.length);
        Some(start..self.rest.start)
    }
}
