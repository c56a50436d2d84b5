// SPDX-License-Identifier: MIT OR Apache-2.0
//! Element-wise operations on two tensors with broadcasting ([`BinaryOperator`]): an axis with
//! one element is repeated. So positions of an input are mapped to those of an output with
//! other axes ([`aligned_mask`]).

use super::{Operator, OperatorJob};
use crate::activation::Activation;
use crate::mask::Mask;
use crate::tensor::{Tensor, TensorForm};
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

/// Returns the positions of an output that depend on those of an input. `to` maps an axis of the
/// input to an axis of the output, or to `None`. Along an axis of positions of both, an output
/// depends on the input at its own index. Along an axis that is an axis of positions of the input
/// alone, an output depends on all inputs. An axis of one element is repeated.
pub(crate) fn aligned_mask(
    (form, mask): (&TensorForm, &Mask),
    output: &TensorForm,
    to: impl Fn(usize) -> Option<usize>,
) -> Mask {
    if !form.has_positions() || !output.has_positions() {
        return full_if(!mask.is_empty(), output);
    }
    // Returns the source of the index for the rows or for the columns of the input.
    let index_source = |axis: Option<usize>| match axis.and_then(&to) {
        Some(output_axis)
            if output.position_axes().len() == 2 && output_axis == output.position_axes().start =>
        {
            AxisIndexSource::Row
        }
        Some(output_axis)
            if output_axis + 1 == output.position_axes().end && output.has_positions() =>
        {
            AxisIndexSource::Column
        }
        Some(_) | None => AxisIndexSource::All,
    };
    let rows =
        index_source((form.position_axes().len() == 2).then_some(form.position_axes().start));
    let columns = index_source(form.position_axes().end.checked_sub(1));
    let is_same = (form.height(), form.width()) == (output.height(), output.width());
    match (rows, columns) {
        (AxisIndexSource::Row, AxisIndexSource::Column) if is_same => mask.clone(),
        (AxisIndexSource::All, AxisIndexSource::Column)
            if is_same && form.position_axes().len() == 1 =>
        {
            mask.clone()
        }
        _ => Mask::from_fn(output.height(), output.width(), |x, y| {
            let range = |along: AxisIndexSource, length: usize| -> Range<usize> {
                let at = match along {
                    AxisIndexSource::All => return 0..length,
                    AxisIndexSource::Row => y,
                    AxisIndexSource::Column => x,
                };
                if length == 1 { 0..1 } else { at..at + 1 }
            };
            mask.has_any(range(rows, form.height()), range(columns, form.width()))
        }),
    }
}

/// The source of the index along an axis of positions of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AxisIndexSource {
    Row,
    Column,
    /// All indices count.
    All,
}

/// Returns all positions if the condition holds, and none otherwise.
pub(crate) fn full_if(is: bool, output: &TensorForm) -> Mask {
    if is {
        Mask::full(output.height(), output.width())
    } else {
        Mask::empty(output.height(), output.width())
    }
}
