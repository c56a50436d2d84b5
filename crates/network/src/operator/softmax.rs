// SPDX-License-Identifier: MIT OR Apache-2.0
//! Exponentials as shares of their sum.

use super::{Job, Operator, everything, only, same_position, values_of};
use crate::form::Form;
use crate::mask::Mask;

/// Along one axis.
#[derive(Clone, Debug)]
pub(crate) struct Softmax {
    pub(crate) axis: i64,
}

impl Operator for Softmax {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let form = only(inputs)?;
        form.axis(self.axis)?;
        Ok(form.clone())
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        let along = output.axis(self.axis).expect("the form has it");
        if output.axes().contains(&along) {
            everything(inputs, output)
        } else {
            same_position(inputs, output)
        }
    }

    fn compute(&self, job: Job<'_>) {
        let Job { inputs, form, output, at, .. } = job;
        if at.is_empty() {
            return;
        }
        let along = form.axis(self.axis).expect("the form has it");
        let length = form.shape()[along];
        let step: usize = form.shape()[along + 1..].iter().product();
        let (from, output) = (inputs[0].values::<f32>(), values_of::<f32>(output, form));
        for start in
            (0..form.elements() / length).map(|line| line / step * step * length + line % step)
        {
            let values = || from[start..].iter().step_by(step).take(length);
            let most = values().fold(f32::NEG_INFINITY, |most, &value| most.max(value));
            let sum: f32 = values().map(|value| (value - most).exp()).sum();
            for (to, value) in output[start..].iter_mut().step_by(step).zip(values()) {
                *to = (value - most).exp() / sum;
            }
        }
    }
}
