// SPDX-License-Identifier: MIT OR Apache-2.0
//! The mean or the largest value over whole axes: global pooling.

use super::{Job, Operator, everything, only, values_of};
use crate::form::Form;
use crate::mask::Mask;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reduction {
    Mean,
    Max,
}

/// A reduction of all axes from one on.
#[derive(Clone, Debug)]
pub(crate) struct Reduce {
    pub(crate) kind: Reduction,
    /// The first axis that is reduced; all that follow are, too.
    pub(crate) from: usize,
    /// Whether they stay, of length 1.
    pub(crate) keep: bool,
}

impl Operator for Reduce {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let shape = only(inputs)?.shape();
        if self.from >= shape.len() {
            return Err(format!("its input has no axis {}", self.from));
        }
        let mut left = shape[..self.from].to_vec();
        if self.keep {
            left.resize(shape.len(), 1);
        }
        let is_features = self.keep && self.from == 2;
        Ok(if is_features { Form::features(left) } else { Form::whole(left) })
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        everything(inputs, output)
    }

    fn compute(&self, job: Job<'_>) {
        let Job { inputs, form, output, at } = job;
        if at.is_empty() {
            return;
        }
        let output = values_of(output, form);
        let length = inputs[0].values::<f32>().len() / output.len();
        for (output, values) in output.iter_mut().zip(inputs[0].values::<f32>().chunks(length)) {
            *output = match self.kind {
                // In double precision, so that a mean over a large picture is as good as over a small one.
                #[allow(
                    clippy::cast_possible_truncation,
                    clippy::cast_precision_loss,
                    reason = "a mean is rounded once"
                )]
                Reduction::Mean => {
                    (values.iter().map(|&value| f64::from(value)).sum::<f64>() / length as f64)
                        as f32
                }
                Reduction::Max => values.iter().fold(f32::NEG_INFINITY, |most, &value| {
                    if value > most || value.is_nan() { value } else { most }
                }),
            };
        }
    }
}
