// SPDX-License-Identifier: MIT OR Apache-2.0
//! Element-wise operations on two tensors with broadcasting: an axis with one element is repeated.

use super::alignment::aligned_mask;
use super::{Operator, OperatorJob};
use crate::activation::Activation;
use crate::mask::Mask;
use crate::tensor::Tensor;
use crate::tensor_form::TensorForm;
use crate::values::TensorNumber;
use std::ops::Range;
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ArithmeticKind {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Min,
    Max,
    /// The first operand where it is not negative, and its product with the second where it is:
    /// `PRelu`.
    PRelu,
}

impl ArithmeticKind {
    #[inline(always)]
    fn apply(self, a: f32, b: f32) -> f32 {
        match self {
            Self::Add => a + b,
            Self::Sub => a - b,
            Self::Mul => a * b,
            Self::Div => a / b,
            Self::Pow => a.powf(b),
            Self::Min => {
                if b < a || b.is_nan() {
                    b
                } else {
                    a
                }
            }
            Self::Max => {
                if b > a || b.is_nan() {
                    b
                } else {
                    a
                }
            }
            Self::PRelu => {
                if a < 0.0 {
                    a * b
                } else {
                    a
                }
            }
        }
    }
}

/// An element-wise operation on two tensors that depend on the frame, or on one such tensor and a
/// constant.
#[derive(Clone, Debug)]
pub(crate) struct BinaryOperator {
    pub(crate) kind: ArithmeticKind,
    /// The constant operand, with true if it is the first operand.
    pub(crate) constant: Option<(Tensor, bool)>,
    /// The activation that is applied to every output.
    pub(crate) activation: Activation,
}

impl BinaryOperator {
    /// Returns both operands in order, one of which may be the constant.
    fn operands<'a, T>(
        &'a self,
        inputs: &[&'a T],
        of: fn(&'a Tensor) -> &'a T,
    ) -> Result<[&'a T; 2], String> {
        match (inputs, &self.constant) {
            (&[a, b], None) => Ok([a, b]),
            (&[a], Some((constant, true))) => Ok([of(constant), a]),
            (&[a], Some((constant, false))) => Ok([a, of(constant)]),
            _ => Err("it takes two tensors".to_owned()),
        }
    }
}

impl Operator for BinaryOperator {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let [a, b] = self.operands(inputs, Tensor::form)?;
        let shape = broadcast_shape(a.shape(), b.shape())
            .ok_or_else(|| format!("{} and {} do not fit together", a.describe(), b.describe()))?;
        Ok(broadcast_form(inputs, shape))
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        broadcast_mask(inputs, output)
    }

    fn with_activation(&self, activation: Activation) -> Option<Arc<dyn Operator>> {
        let is_free = self.activation == Activation::Identity;
        is_free.then(|| Arc::new(Self { activation, ..self.clone() }) as Arc<dyn Operator>)
    }

    fn weight_bytes(&self) -> u64 {
        self.constant.as_ref().map_or(0, |(constant, _)| constant.form().bytes())
    }

    fn compute(&self, job: OperatorJob<'_>) {
        // An operation that is known at compile time needs no choice in the loop.
        match (self.kind, self.activation) {
            (ArithmeticKind::Add, Activation::Identity) => {
                self.compute_lines(job, |a: f32, b| a + b);
            }
            (ArithmeticKind::Add, Activation::Relu) => {
                self.compute_lines(job, |a: f32, b| Activation::Relu.apply(a + b));
            }
            (ArithmeticKind::Sub, Activation::Identity) => {
                self.compute_lines(job, |a: f32, b| a - b);
            }
            (ArithmeticKind::Mul, Activation::Identity) => {
                self.compute_lines(job, |a: f32, b| a * b);
            }
            (ArithmeticKind::Div, Activation::Identity) => {
                self.compute_lines(job, |a: f32, b| a / b);
            }
            (kind, activation) => {
                self.compute_lines(job, |a, b| activation.apply(kind.apply(a, b)));
            }
        }
    }
}

impl BinaryOperator {
    /// Computes the output, line by line along the last axis.
    pub(super) fn compute_lines<T: TensorNumber, Y: TensorNumber>(
        &self,
        job: OperatorJob<'_>,
        operation: impl Fn(T, T) -> Y + Sync,
    ) {
        let (inputs, form) = (job.inputs, job.form);
        let [a, b] =
            self.operands(inputs, |tensor| tensor).expect("the form says how many there are");
        let (strides_of_a, strides_of_b) =
            (form.broadcast_strides(a.form()), form.broadcast_strides(b.form()));
        let last = form.shape().last().copied().unwrap_or(1);
        if [a, b].iter().all(|operand| operand.form().shape() == form.shape()) {
            let (a, b) = (a.values(), b.values());
            return job.fill(|run, to| compute_line(&a[run.clone()], &b[run], to, &operation));
        }
        job.fill(|run, to| {
            let (first, mut start) = (run.start, run.start);
            while start < run.end {
                let end = run.end.min((start / last + 1) * last);
                let (a, b) = (
                    line_values(a, &strides_of_a, form, start..end),
                    line_values(b, &strides_of_b, form, start..end),
                );
                let to = &mut to[start - first..end - first];
                compute_line(a, b, to, &operation);
                start = end;
            }
        });
    }
}

/// Computes a line of values. An operand of one value is repeated.
#[inline(always)]
fn compute_line<T: Copy, Y: Copy>(a: &[T], b: &[T], to: &mut [Y], operation: impl Fn(T, T) -> Y) {
    match (a.len() == to.len(), b.len() == to.len()) {
        (true, true) => {
            to.iter_mut().zip(a.iter().zip(b)).for_each(|(to, (&a, &b))| *to = operation(a, b));
        }
        (true, false) => to.iter_mut().zip(a).for_each(|(to, &a)| *to = operation(a, b[0])),
        (false, true) => to.iter_mut().zip(b).for_each(|(to, &b)| *to = operation(a[0], b)),
        (false, false) => to.fill(operation(a[0], b[0])),
    }
}

/// Returns the form of a broadcast result with this shape. Its positions are those of the input
/// that has the most axes of positions and repeats none of them.
pub(super) fn broadcast_form(inputs: &[&TensorForm], shape: Vec<usize>) -> TensorForm {
    let new_axes = |form: &TensorForm| shape.len() - form.shape().len();
    let axes = |form: &TensorForm| {
        form.position_axes().start + new_axes(form)..form.position_axes().end + new_axes(form)
    };
    let is_kept = |form: &&&TensorForm| {
        form.has_positions()
            && axes(form).all(|axis| shape[axis] == form.shape()[axis - new_axes(form)])
    };
    let kept = inputs.iter().filter(is_kept).rev().max_by_key(|form| form.position_axes().len());
    match kept.map(|form| axes(form)) {
        Some(axes) => TensorForm::with_positions(shape, axes),
        None => TensorForm::without_positions(shape),
    }
}

/// Returns the positions of a broadcast result that depend on changed positions of the inputs.
pub(super) fn broadcast_mask(inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
    let mut changed = Mask::empty(output.height(), output.width());
    for &(form, mask) in inputs {
        let new_axes = output.shape().len() - form.shape().len();
        changed.union(&aligned_mask((form, mask), output, |axis| Some(axis + new_axes)));
    }
    changed
}

/// Returns the shape of both operands after broadcasting, or `None` if they do not fit together.
pub(crate) fn broadcast_shape(a: &[usize], b: &[usize]) -> Option<Vec<usize>> {
    let axes = a.len().max(b.len());
    let size = |shape: &[usize], axis: usize| {
        (axis + shape.len()).checked_sub(axes).map_or(1, |axis| shape[axis])
    };
    let broadcast_length = |axis| match (size(a, axis), size(b, axis)) {
        (a, b) if a == b || b == 1 => Some(a),
        (1, b) => Some(b),
        _ => None,
    };
    (0..axes).map(broadcast_length).collect()
}

/// Returns the values of an operand for a line of the output, or the single value that is repeated
/// along the line.
fn line_values<'a, T: TensorNumber>(
    operand: &'a Tensor,
    steps: &[usize],
    output: &TensorForm,
    line: Range<usize>,
) -> &'a [T] {
    let at = output.offset(line.start, steps);
    let is_repeated = steps.last().is_none_or(|&step| step == 0);
    &operand.values()[at..if is_repeated { at + 1 } else { at + line.len() }]
}
