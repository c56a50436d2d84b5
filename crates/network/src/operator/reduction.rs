// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reductions of axes to a single value: global pooling, sums and norms
//! ([`ReductionOperator`]), and the index of the largest value ([`ArgMax`]). An axis is removed
//! or keeps the length 1 ([`ReducedAxes`]).

use super::binary_operator::aligned_mask;
use super::{Operator, OperatorJob, only_input};
use crate::element::{ElementType, Encoding};
use crate::mask::Mask;
use crate::tensor::TensorForm;
use crate::values::TensorNumber;

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
