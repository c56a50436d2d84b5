// SPDX-License-Identifier: MIT OR Apache-2.0
//! The product of two matrices that both depend on the frame, as in attention.

use super::arithmetic::broadcast;
use super::{Job, Operator, Products, values_of};
use crate::form::Form;
use crate::mask::Mask;
use crate::threads;
use foveate_lanes::{Level, Task};

#[derive(Clone, Debug)]
pub(crate) struct Product {
    pub(crate) level: Level,
    /// The number of products of a sum.
    pub(crate) inner: usize,
}

/// Returns the leading axes of a tensor of matrices, and the rows and columns of a matrix, which
/// are its last two axes.
fn matrix(form: &Form) -> Result<(&[usize], [usize; 2]), String> {
    match form.shape() {
        [front @ .., rows, columns] => Ok((front, [*rows, *columns])),
        _ => Err(format!("a matrix has two axes or more, not {}", form.describe())),
    }
}

impl Operator for Product {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let &[a, b] = inputs else { return Err("it takes two tensors".to_owned()) };
        let ((front_a, [rows, inner]), (front_b, [other, columns])) = (matrix(a)?, matrix(b)?);
        let front = broadcast(front_a, front_b).filter(|_| inner == other);
        let mut shape = front
            .ok_or_else(|| format!("{} and {} do not fit together", a.describe(), b.describe()))?;
        shape.extend([rows, columns]);
        // Positions among the axes before the last remain positions.
        let new = shape.len() - a.shape().len();
        let axes = a.axes().start + new..a.axes().end + new;
        let is_kept = a.has_positions()
            && axes.end < shape.len()
            && axes.clone().all(|axis| shape[axis] == a.shape()[axis - new]);
        Ok(if is_kept { Form::at(shape, axes) } else { Form::whole(shape) })
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        let [(_, mask), (_, other)] = inputs else { unreachable!("the form says how many") };
        // Every row of the result depends on the whole second matrix.
        if output.has_positions() && other.is_empty() {
            (*mask).clone()
        } else {
            super::everything(inputs, output)
        }
    }

    fn compute(&self, job: Job<'_>) {
        let Job { inputs, form, output, .. } = job;
        let (a, b) = (inputs[0], inputs[1]);
        let Ok((_, [rows, inner])) = matrix(a.form()) else { unreachable!("the form has it") };
        let columns = form.shape()[form.shape().len() - 1];
        let fronts = form.shape().len() - 2;
        let front = Form::whole(form.shape()[..fronts].to_vec());
        // The strides of the matrices of each operand. They are 0 along axes in which the operand
        // is repeated.
        let steps = |of: &Form| form.steps_of(of)[..fronts].to_vec();
        let (steps_a, steps_b) = (steps(a.form()), steps(b.form()));
        let (a, b) = (a.values::<f32>(), b.values::<f32>());
        threads::each_chunk(values_of::<f32>(output, form), rows * columns, &|number, to| {
            let a = &a[front.offset(number, &steps_a)..][..rows * inner];
            let b = &b[front.offset(number, &steps_b)..][..inner * columns];
            self.level.run(Rows { a, b, to, inner, columns });
        });
    }

    fn products(&self) -> Products {
        Products::Matrix { inputs: self.inner }
    }
}

/// The computation of one matrix of the output.
struct Rows<'a> {
    a: &'a [f32],
    b: &'a [f32],
    to: &'a mut [f32],
    inner: usize,
    columns: usize,
}

impl Task for Rows<'_> {
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
