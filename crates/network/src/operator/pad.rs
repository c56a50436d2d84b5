// SPDX-License-Identifier: MIT OR Apache-2.0
//! A constant around the rows and columns of features.

use super::{Job, Operator, features, moved, only, wanted};
use crate::element::{Encoding, typed};
use crate::form::Form;
use crate::mask::{Mask, Window};
use crate::tensor::Tensor;

#[derive(Clone, Debug)]
pub(crate) struct Pad {
    /// Above, to the left, below and to the right.
    pub(crate) around: [usize; 4],
    /// One value.
    pub(crate) value: Tensor,
}

impl Pad {
    fn windows(&self) -> [Window; 2] {
        let [top, left, bottom, right] = self.around;
        let window = |before, after| Window { before, after, ..Window::SAME };
        [window(top, bottom), window(left, right)]
    }
}

impl Operator for Pad {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let [channels, height, width] = features(only(inputs)?)?;
        let [top, left, bottom, right] = self.around;
        Ok(Form::features(vec![1, channels, height + top + bottom, width + left + right]))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.first() {
            Some(input) if input.element != self.value.form().encoding().element => {
                Err(wanted(self.value.form().encoding().element, input.element))
            }
            _ => moved(inputs),
        }
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        let [rows, columns] = self.windows();
        inputs[0].1.through(rows, columns, output.height(), output.width())
    }

    fn compute(&self, job: Job<'_>) {
        let (inputs, form) = (job.inputs, job.form);
        let (height, width) = (inputs[0].form().height(), inputs[0].form().width());
        let [rows, columns] = self.windows();
        typed!(form.encoding().element, T => job.fill::<T>(|run, to| {
            for (place, to) in run.zip(to) {
                let (channel, y, x) = form.coordinates(place);
                *to = match (rows.input(y, 0, height), columns.input(x, 0, width)) {
                    (Some(y), Some(x)) => inputs[0].values()[(channel * height + y) * width + x],
                    _ => self.value.values()[0],
                };
            }
        }));
    }
}
