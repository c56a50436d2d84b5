// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reductions of axes to a single value: global pooling, sums and norms, and the index of the
//! largest value.

use super::reduced_axes::ReducedAxes;
use super::{Operator, OperatorJob};
use crate::element::{ElementType, Encoding};
use crate::mask::Mask;
use crate::tensor_form::TensorForm;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ReductionKind {
    Mean,
    Max,
    Min,
    Sum,
    /// The sum of the absolute values.
    L1,
    /// The square root of the sum of the squares.
    L2,
    SumSquare,
    Prod,
}

impl ReductionKind {
    /// Reduces the values in double precision, so that a sum over a large frame is as exact as one
    /// over a small frame.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "a result is rounded once"
    )]
    fn reduce(self, values: &mut dyn Iterator<Item = &[f32]>) -> f32 {
        let fold =
            |start: f64, values: &mut dyn Iterator<Item = &[f32]>, add: fn(f64, f64) -> f64| {
                let each = |sum, values: &[f32]| {
                    values.iter().fold(sum, |sum, &value| add(sum, f64::from(value)))
                };
                values.fold(start, each)
            };
        let most =
            |most: f64, value: f64| if value > most || value.is_nan() { value } else { most };
        let least =
            |least: f64, value: f64| if value < least || value.is_nan() { value } else { least };
        let value = match self {
            Self::Mean => {
                let mut count = 0;
                let mut counted = values.inspect(|values| count += values.len());
                fold(0.0, &mut counted, |sum, value| sum + value) / count as f64
            }
            Self::Max => fold(f64::NEG_INFINITY, values, most),
            Self::Min => fold(f64::INFINITY, values, least),
            Self::Sum => fold(0.0, values, |sum, value| sum + value),
            Self::L1 => fold(0.0, values, |sum, value| sum + value.abs()),
            Self::L2 => fold(0.0, values, |sum, value| sum + value * value).sqrt(),
            Self::SumSquare => fold(0.0, values, |sum, value| sum + value * value),
            Self::Prod => fold(1.0, values, |product, value| product * value),
        };
        value as f32
    }
}

#[derive(Clone, Debug)]
pub(crate) struct ReductionOperator {
    pub(crate) kind: ReductionKind,
    pub(crate) reduced_axes: ReducedAxes,
}

impl Operator for ReductionOperator {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        self.reduced_axes.form(inputs)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        self.reduced_axes.spread(inputs[0], output)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        self.reduced_axes.fill(job, |values| self.kind.reduce(values));
    }
}

/// The index of the largest or the lowest value along an axis.
#[derive(Clone, Debug)]
pub(crate) struct ArgMax {
    pub(crate) reduced_axes: ReducedAxes,
    pub(crate) takes_lowest: bool,
    /// True if the last of several equal values is taken, false if the first is.
    pub(crate) takes_last: bool,
}

impl Operator for ArgMax {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        self.reduced_axes.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match inputs.iter().find(|input| input.element != ElementType::F32) {
            None => Ok(Encoding::plain(ElementType::I32)),
            Some(input) => Err(super::wrong_element_message(ElementType::F32, input.element)),
        }
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        self.reduced_axes.spread(inputs[0], output)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        self.reduced_axes.fill(job, |values| {
            let mut best: Option<(i32, f32)> = None;
            for (at, &value) in (0..).zip(values.flatten()) {
                let is_better = best.is_none_or(|(_, best)| {
                    let is_beyond = if self.takes_lowest { value < best } else { value > best };
                    is_beyond || (self.takes_last && value == best)
                });
                if is_better {
                    best = Some((at, value));
                }
            }
            best.map_or(0, |(at, _)| at)
        });
    }
}
