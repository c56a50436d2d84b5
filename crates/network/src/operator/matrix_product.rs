// SPDX-License-Identifier: MIT OR Apache-2.0
//! Products of matrices: of two that depend on the frame, as in attention ([`MatrixProduct`]),
//! and of the last axis with a constant matrix, as in fully connected layers, of floating-point
//! values ([`Linear`]) or of 8-bit values ([`IntegerMatMul`]).

use super::binary_operator::broadcast_shape;
use super::integer_conv::ByteWeightRows;
use super::quantization::{Requantization, SumOutput};
use super::{Operator, OperatorJob, ProductKind, encoding_from_bytes, only_input, output_values};
use crate::element::{Encoding, with_byte_type, with_element_type};
use crate::mask::Mask;
use crate::tensor::TensorForm;
use crate::threads;
use crate::values::ByteNumber;
use foveate_pixels::vectors::{InstructionSet, VectorTask};

#[derive(Clone, Debug)]
pub(crate) struct MatrixProduct {
    pub(crate) level: InstructionSet,
    /// The number of products of a sum.
    pub(crate) depth: usize,
}

/// Returns the leading axes of a tensor of matrices, and the rows and columns of a matrix, which
/// are its last two axes.
fn matrix_axes(form: &TensorForm) -> Result<(&[usize], [usize; 2]), String> {
    match form.shape() {
        [front @ .., rows, columns] => Ok((front, [*rows, *columns])),
        _ => Err(format!("a matrix has two axes or more, not {}", form.describe())),
    }
}

impl Operator for MatrixProduct {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let &[a, b] = inputs else { return Err("it takes two tensors".to_owned()) };
        let ((front_a, [rows, inner]), (front_b, [other, columns])) =
            (matrix_axes(a)?, matrix_axes(b)?);
        let front = broadcast_shape(front_a, front_b).filter(|_| inner == other);
        let mut shape = front
            .ok_or_else(|| format!("{} and {} do not fit together", a.describe(), b.describe()))?;
        shape.extend([rows, columns]);
        // Positions among the axes before the last remain positions.
        let new = shape.len() - a.shape().len();
        let axes = a.position_axes().start + new..a.position_axes().end + new;
        let is_kept = a.has_positions()
            && axes.end < shape.len()
            && axes.clone().all(|axis| shape[axis] == a.shape()[axis - new]);
        Ok(if is_kept {
            TensorForm::with_positions(shape, axes)
        } else {
            TensorForm::without_positions(shape)
        })
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let [(_, mask), (_, other)] = inputs else { unreachable!("the form says how many") };
        // Every row of the result depends on the whole second matrix.
        if output.has_positions() && other.is_empty() {
            (*mask).clone()
        } else {
            super::full_if_changed(inputs, output)
        }
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, .. } = job;
        let (a, b) = (inputs[0], inputs[1]);
        let Ok((_, [rows, inner])) = matrix_axes(a.form()) else { unreachable!("the form has it") };
        let columns = form.shape()[form.shape().len() - 1];
        let fronts = form.shape().len() - 2;
        let front = TensorForm::without_positions(form.shape()[..fronts].to_vec());
        // The strides of the matrices of each operand. They are 0 along axes in which the operand
        // is repeated.
        let steps = |of: &TensorForm| form.broadcast_strides(of)[..fronts].to_vec();
        let (steps_a, steps_b) = (steps(a.form()), steps(b.form()));
        let (a, b) = (a.values::<f32>(), b.values::<f32>());
        threads::for_each_chunk(
            output_values::<f32>(output, form),
            rows * columns,
            &|number, to| {
                let a = &a[front.offset(number, &steps_a)..][..rows * inner];
                let b = &b[front.offset(number, &steps_b)..][..inner * columns];
                self.level.run(MatrixProductTask { a, b, to, inner, columns });
            },
        );
    }

    fn products(&self) -> ProductKind {
        ProductKind::Matrix { inputs: self.depth }
    }
}

/// The computation of one matrix of the output.
struct MatrixProductTask<'a> {
    a: &'a [f32],
    b: &'a [f32],
    to: &'a mut [f32],
    inner: usize,
    columns: usize,
}

impl VectorTask for MatrixProductTask<'_> {
    #[inline(always)]
    fn run(self) {
        let rows = self.to.chunks_mut(self.columns).zip(self.a.chunks(self.inner));
        for (to, factors) in rows {
            to.fill(0.0);
            for (&factor, from) in factors.iter().zip(self.b.chunks(self.columns)) {
                to.iter_mut().zip(from).for_each(|(to, &from)| *to += factor * from);
            }
        }
    }
}

#[derive(Clone, Debug)]
pub(crate) struct IntegerMatMul {
    /// The weights, with one row per output.
    pub(crate) rows: ByteWeightRows,
    pub(crate) inputs: usize,
    /// The zero point of the input.
    pub(crate) zero_point: i32,
    pub(crate) sums: Requantization,
}

impl IntegerMatMul {
    fn multiply<X: ByteNumber, Y: SumOutput>(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, .. } = job;
        let rows = inputs[0].values::<X>();
        let outputs = output_values::<Y>(output, form);
        threads::for_each_chunk(outputs, self.rows.zero_points.len(), &|number, outputs| {
            let input = &rows[number * self.inputs..][..self.inputs];
            let weights = self.rows.values.chunks(self.inputs).zip(&self.rows.zero_points);
            for ((channel, output), weights) in outputs.iter_mut().enumerate().zip(weights) {
                let (row, &zero) = weights;
                *output = self.sums.requantize(channel, dot(row, zero, input, self.zero_point));
            }
        });
    }
}

impl Operator for IntegerMatMul {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        matrix_product_form(inputs, self.inputs, self.rows.zero_points.len())
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        encoding_from_bytes(inputs, self.sums.to)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        if !job.positions.is_empty() {
            with_byte_type!(job.inputs[0].form().encoding().element, X => {
                with_element_type!(self.sums.to.element, Y => self.multiply::<X, Y>(job));
            });
        }
    }

    fn products(&self) -> ProductKind {
        ProductKind::Matrix { inputs: self.inputs }
    }

    fn scheduled_positions(&self, at: &Mask) -> usize {
        if at.is_empty() { 0 } else { at.height() * at.width() }
    }

    fn weight_bytes(&self) -> u64 {
        self.rows.byte_count() + self.sums.bytes()
    }
}

/// Returns the dot product of a row of weights with the inputs, both less their zero points.
fn dot<X: ByteNumber>(weights: &[i8], weights_zero: i8, inputs: &[X], zero: i32) -> i32 {
    let product = |(&weight, &input): (&i8, &X)| {
        let input: i32 = input.into();
        (i32::from(weight) - i32::from(weights_zero)) * (input - zero)
    };
    weights.iter().zip(inputs).map(product).fold(0, i32::wrapping_add)
}

/// The number of partial sums of a row_dot product. They are added at the end, in a fixed order.
const PARTIAL_SUMS: usize = 16;

/// Returns the row_dot product of two rows, always summed in the same order.
fn row_dot(a: &[f32], b: &[f32]) -> f32 {
    let mut parts = [0.0f32; PARTIAL_SUMS];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<PARTIAL_SUMS>(), b.as_chunks::<PARTIAL_SUMS>());
    for (a, b) in a.iter().zip(b) {
        for part in 0..PARTIAL_SUMS {
            parts[part] += a[part] * b[part];
        }
    }
    let rest: f32 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    parts.iter().sum::<f32>() + rest
}

/// Returns the form of the product of the last axis with a matrix of `inner` x `outputs` values.
pub(super) fn matrix_product_form(
    inputs: &[&TensorForm],
    inner: usize,
    outputs: usize,
) -> Result<TensorForm, String> {
    let form = only_input(inputs)?;
    let mut shape = form.shape().to_vec();
    match shape.last_mut() {
        Some(last) if *last == inner => *last = outputs,
        _ => return Err(format!("its matrix takes {inner} values, not {}", form.describe())),
    }
    // Positions before the last axis remain positions.
    let last = shape.len() - 1;
    Ok(if form.has_positions() && form.position_axes().end <= last {
        TensorForm::with_positions(shape, form.position_axes())
    } else {
        TensorForm::without_positions(shape)
    })
}

/// The product of the last axis with a constant matrix, plus a bias.
#[derive(Clone, Debug)]
pub(crate) struct Linear {
    /// The weights, with one row per output.
    weights: Vec<f32>,
    /// The bias: one value per output, or empty.
    bias: Vec<f32>,
    inputs: usize,
    /// True if the input must have two axes.
    needs_two_axes: bool,
}

impl Linear {
    /// Returns the product with a constant of `inputs` x `outputs` values, without a bias.
    pub(crate) fn from_matrix(shape: &[usize], weights: &[f32]) -> Result<Self, String> {
        let linear = Self::new(shape, weights, None, false, 1.0, 1.0)?;
        Ok(Self { bias: Vec::new(), needs_two_axes: false, ..linear })
    }

    /// Returns `alpha * weights * input + beta * bias`. The weights are `inputs` x `outputs`
    /// values, or `outputs` x `inputs` if `transposed`.
    pub(crate) fn new(
        shape: &[usize],
        weights: &[f32],
        bias: Option<&[f32]>,
        transposed: bool,
        alpha: f32,
        beta: f32,
    ) -> Result<Self, String> {
        let &[rows, columns] = shape else {
            return Err(format!("its weights have {} axes, not 2", shape.len()));
        };
        let (outputs, inputs) = if transposed { (rows, columns) } else { (columns, rows) };
        let at = |output: usize, input: usize| {
            if transposed { output * inputs + input } else { input * outputs + output }
        };
        let row = |output| (0..inputs).map(move |input| alpha * weights[at(output, input)]);
        let bias = match bias {
            None => vec![0.0; outputs],
            Some(&[one]) => vec![beta * one; outputs],
            Some(bias) if bias.len() == outputs => bias.iter().map(|bias| beta * bias).collect(),
            Some(bias) => {
                return Err(format!("its bias has {} values for {outputs} outputs", bias.len()));
            }
        };
        Ok(Self {
            weights: (0..outputs).flat_map(row).collect(),
            bias,
            inputs,
            needs_two_axes: true,
        })
    }

    fn outputs(&self) -> usize {
        self.weights.len() / self.inputs
    }
}

impl Operator for Linear {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let form = only_input(inputs)?;
        if self.needs_two_axes && form.shape().len() != 2 {
            return Err(format!("it takes [rows, {}], not {}", self.inputs, form.describe()));
        }
        matrix_product_form(inputs, self.inputs, self.outputs())
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, positions: at } = job;
        if at.is_empty() {
            return;
        }
        let (outputs, input) = (self.outputs(), inputs[0].values::<f32>());
        threads::for_each_chunk(output_values::<f32>(output, form), 1, &|place, output| {
            let (row, column) = (place / outputs, place % outputs);
            let bias = self.bias.get(column).copied().unwrap_or(0.0);
            let weights = &self.weights[column * self.inputs..][..self.inputs];
            output[0] = bias + row_dot(weights, &input[row * self.inputs..][..self.inputs]);
        });
    }

    fn products(&self) -> ProductKind {
        ProductKind::Matrix { inputs: self.inputs }
    }

    fn scheduled_positions(&self, at: &Mask) -> usize {
        if at.is_empty() { 0 } else { at.height() * at.width() }
    }

    fn weight_bytes(&self) -> u64 {
        4 * (self.weights.len() + self.bias.len()) as u64
    }
}
