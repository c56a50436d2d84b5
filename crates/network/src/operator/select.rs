// SPDX-License-Identifier: MIT OR Apache-2.0
//! Comparisons, whose results are 0 and 1, and selection by them.

use super::arithmetic::{broadcast, repeated, together};
use super::{Job, Operator, wanted};
use crate::element::{Element, Encoding};
use crate::form::Form;
use crate::mask::Mask;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Comparison {
    Equal,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
}

/// The comparison of two tensors, value by value; the result is 1 where it holds.
#[derive(Clone, Debug)]
pub(crate) struct Compare(pub(crate) Comparison);

/// Returns the form of all inputs broadcast together.
fn form(inputs: &[&Form]) -> Result<Form, String> {
    let mut shape = Vec::new();
    for input in inputs {
        shape = broadcast(&shape, input.shape())
            .ok_or_else(|| format!("{shape:?} and {} do not fit together", input.describe()))?;
    }
    Ok(together(inputs, shape))
}

impl Operator for Compare {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.iter().find(|input| input.element != Element::F32) {
            None => Ok(Encoding::plain(Element::U8)),
            Some(input) => Err(wanted(Element::F32, input.element)),
        }
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        repeated(inputs, output)
    }

    fn compute(&self, job: Job<'_>) {
        let (inputs, form) = (job.inputs, job.form);
        let [a, b] =
            [0, 1].map(|at| (inputs[at].values::<f32>(), form.steps_of(inputs[at].form())));
        job.fill::<u8>(|run, to| {
            for (place, to) in run.zip(to) {
                let [a, b] = [&a, &b].map(|(values, steps)| values[form.offset(place, steps)]);
                *to = u8::from(match self.0 {
                    Comparison::Equal => a == b,
                    Comparison::Greater => a > b,
                    Comparison::GreaterOrEqual => a >= b,
                    Comparison::Less => a < b,
                    Comparison::LessOrEqual => a <= b,
                });
            }
        });
    }
}

/// Selection: the second input where the first is not 0, and the third elsewhere.
#[derive(Clone, Debug)]
pub(crate) struct Select;

impl Operator for Select {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        let kinds: Vec<Element> = inputs.iter().map(|input| input.element).collect();
        match kinds.as_slice() {
            [Element::U8, Element::F32, Element::F32] => Ok(Encoding::FLOAT),
            _ => Err("it takes truth values and two tensors of floating-point values".to_owned()),
        }
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        repeated(inputs, output)
    }

    fn compute(&self, job: Job<'_>) {
        let (inputs, form) = (job.inputs, job.form);
        let steps = |at: usize| form.steps_of(inputs[at].form());
        let (conditions, of_conditions) = (inputs[0].values::<u8>(), steps(0));
        let [chosen, other] = [1, 2].map(|at| (inputs[at].values::<f32>(), steps(at)));
        job.fill::<f32>(|run, to| {
            for (place, to) in run.zip(to) {
                let is = conditions[form.offset(place, &of_conditions)] != 0;
                let (values, steps) = if is { &chosen } else { &other };
                *to = values[form.offset(place, steps)];
            }
        });
    }
}
