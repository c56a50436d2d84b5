// SPDX-License-Identifier: MIT OR Apache-2.0
//! Comparisons, whose results are 0 and 1, and selection by them.

use super::binary_operator::{broadcast_form, broadcast_mask, broadcast_shape};
use super::{Operator, OperatorJob, wrong_element_message};
use crate::element::{ElementType, Encoding};
use crate::mask::Mask;
use crate::tensor::TensorForm;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ComparisonKind {
    Equal,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
}

/// The comparison of two tensors, value by value; the result is 1 where it holds.
#[derive(Clone, Debug)]
pub(crate) struct ComparisonOperator(pub(crate) ComparisonKind);

/// Returns the form of all inputs broadcast together.
fn broadcast_form_of(inputs: &[&TensorForm]) -> Result<TensorForm, String> {
    let mut shape = Vec::new();
    for input in inputs {
        shape = broadcast_shape(&shape, input.shape())
            .ok_or_else(|| format!("{shape:?} and {} do not fit together", input.describe()))?;
    }
    Ok(broadcast_form(inputs, shape))
}

impl Operator for ComparisonOperator {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        broadcast_form_of(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.iter().find(|input| input.element != ElementType::F32) {
            None => Ok(Encoding::plain(ElementType::U8)),
            Some(input) => Err(wrong_element_message(ElementType::F32, input.element)),
        }
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        broadcast_mask(inputs, output)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let (inputs, form) = (job.inputs, job.form);
        let [a, b] = [0, 1]
            .map(|at| (inputs[at].values::<f32>(), form.broadcast_strides(inputs[at].form())));
        job.fill::<u8>(|run, to| {
            for (place, to) in run.zip(to) {
                let [a, b] = [&a, &b].map(|(values, steps)| values[form.offset(place, steps)]);
                *to = u8::from(match self.0 {
                    ComparisonKind::Equal => a == b,
                    ComparisonKind::Greater => a > b,
                    ComparisonKind::GreaterOrEqual => a >= b,
                    ComparisonKind::Less => a < b,
                    ComparisonKind::LessOrEqual => a <= b,
                });
            }
        });
    }
}

/// Selection: the second input where the first is not 0, and the third elsewhere.
#[derive(Clone, Debug)]
pub(crate) struct WhereOperator;

impl Operator for WhereOperator {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        broadcast_form_of(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        let kinds: Vec<ElementType> = inputs.iter().map(|input| input.element).collect();
        match kinds.as_slice() {
            [ElementType::U8, ElementType::F32, ElementType::F32] => Ok(Encoding::FLOAT),
            _ => Err("it takes truth values and two tensors of floating-point values".to_owned()),
        }
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        broadcast_mask(inputs, output)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let (inputs, form) = (job.inputs, job.form);
        let steps = |at: usize| form.broadcast_strides(inputs[at].form());
        let (conditions, condition_steps) = (inputs[0].values::<u8>(), steps(0));
        let [chosen, other] = [1, 2].map(|at| (inputs[at].values::<f32>(), steps(at)));
        job.fill::<f32>(|run, to| {
            for (place, to) in run.zip(to) {
                let holds = conditions[form.offset(place, &condition_steps)] != 0;
                let (values, steps) = if holds { &chosen } else { &other };
                *to = values[form.offset(place, steps)];
            }
        });
    }
}
