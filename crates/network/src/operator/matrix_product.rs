// SPDX-License-Identifier: MIT OR Apache-2.0
//! The product of two matrices that both depend on the frame, as in attention.

use super::binary_operator::broadcast_shape;
use super::{Operator, OperatorJob, ProductKind, output_values};
use crate::mask::Mask;
use crate::tensor_form::TensorForm;
use crate::threads;
use foveate_pixels::lanes::{InstructionSet, VectorTask};

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
