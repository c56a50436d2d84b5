// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operators that move the values of channels as they are: they join tensors along an axis
//! ([`Concat`]), or move channels into blocks of neighboring positions ([`DepthToSpace`]) and
//! back ([`SpaceToDepth`]).

use super::binary_operator::{aligned_mask, broadcast_mask};
use super::{Operator, OperatorJob, feature_size, moved_encoding, only_input};
use crate::element::{Encoding, with_element_type};
use crate::mask::{AxisWindow, Mask};
use crate::tensor::TensorForm;
use crate::values::TensorNumber;

#[derive(Clone, Debug)]
pub(crate) struct Concat {
    /// The axis; a negative number counts from the end.
    pub(crate) axis: i64,
}

impl Operator for Concat {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let first = *inputs.first().ok_or("it has no inputs")?;
        let axis = first.resolve_axis(self.axis)?;
        let mut shape = first.shape().to_vec();
        for form in &inputs[1..] {
            let fits = form.shape().len() == shape.len()
                && (0..shape.len()).all(|at| at == axis || form.shape()[at] == shape[at]);
            if !fits {
                return Err(format!(
                    "{} and {} do not fit together along axis {axis}",
                    first.describe(),
                    form.describe()
                ));
            }
            shape[axis] += form.shape()[axis];
        }
        // The positions of the output are the axes that are positions in all inputs that have
        // positions.
        let positions =
            inputs.iter().map(|form| form.position_axes()).filter(|axes| !axes.is_empty());
        let common = positions.reduce(|a, b| a.start.max(b.start)..a.end.min(b.end));
        Ok(match common.filter(|axes| !axes.is_empty()) {
            Some(axes) => TensorForm::with_positions(shape, axes),
            None => TensorForm::without_positions(shape),
        })
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved_encoding(inputs)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let axis = output.resolve_axis(self.axis).expect("the form has it");
        if !output.position_axes().contains(&axis) {
            return broadcast_mask(inputs, output);
        }
        let is_column = axis + 1 == output.position_axes().end;
        let mut dependent = Mask::empty(output.height(), output.width());
        let mut first = 0;
        for &(form, mask) in inputs {
            let aligned_form =
                TensorForm::with_positions(form.shape().to_vec(), output.position_axes());
            let mask = aligned_mask((form, mask), &aligned_form, Some);
            let (left, top) = if is_column { (first, 0) } else { (0, first) };
            for y in 0..mask.height() {
                for (x, length) in mask.runs(y) {
                    (x..x + length).for_each(|x| dependent.insert(left + x, top + y));
                }
            }
            first += form.shape()[axis];
        }
        dependent
    }

    fn compute(&self, job: OperatorJob<'_>) {
        with_element_type!(job.form.encoding().element, T => {
            self.copy_inputs(job, |_, from: &[T], to: &mut [T]| to.copy_from_slice(from));
        });
    }
}

impl Concat {
    /// Copies the values of every input to their place in the output. `copy` takes the number of
    /// the input.
    pub(super) fn copy_inputs<T: TensorNumber, Y: TensorNumber>(
        &self,
        job: OperatorJob<'_>,
        copy: impl Fn(usize, &[T], &mut [Y]) + Sync,
    ) {
        let (inputs, form) = (job.inputs, job.form);
        let axis = form.resolve_axis(self.axis).expect("the form has it");
        let values_from_axis = |form: &TensorForm| form.shape()[axis..].iter().product::<usize>();
        let line_values = values_from_axis(form);
        // The end of each input in a line of the output.
        let ends: Vec<usize> = inputs
            .iter()
            .scan(0, |end, input| {
                *end += values_from_axis(input.form());
                Some(*end)
            })
            .collect();
        job.fill::<Y>(|run, to| {
            let (mut start, mut to) = (run.start, to);
            while !to.is_empty() {
                let (line, inside) = (start / line_values, start % line_values);
                let number = ends.partition_point(|&end| end <= inside);
                let first = number.checked_sub(1).map_or(0, |before| ends[before]);
                let (part, rest) = to.split_at_mut(to.len().min(ends[number] - inside));
                let from = line * (ends[number] - first) + inside - first;
                copy(number, &inputs[number].values()[from..from + part.len()], part);
                start += part.len();
                to = rest;
            }
        });
    }
}

/// The order of the channels that hold one block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DepthToSpaceOrder {
    /// The index in the block varies slowest: mode `DCR` of ONNX.
    DepthColumnRow,
    /// The channel varies slowest: mode `CRD` of ONNX.
    ColumnRowDepth,
}

/// Moves channels into blocks of `side` x `side` positions.
#[derive(Clone, Debug)]
pub(crate) struct DepthToSpace {
    pub(crate) block_size: usize,
    pub(crate) order: DepthToSpaceOrder,
}

impl Operator for DepthToSpace {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let [channels, height, width] = feature_size(only_input(inputs)?)?;
        let square = self.block_size * self.block_size;
        if channels % square != 0 {
            return Err(format!("{channels} channels are not a multiple of the square {square}"));
        }
        Ok(TensorForm::features(vec![
            1,
            channels / square,
            height * self.block_size,
            width * self.block_size,
        ]))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved_encoding(inputs)
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let sources = |outputs: usize| -> Vec<(usize, usize)> {
            (0..outputs).map(|at| (at / self.block_size, at / self.block_size)).collect()
        };
        inputs[0].1.outputs_of_ranges(&sources(output.height()), &sources(output.width()))
    }

    fn takes_features(&self) -> bool {
        true
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let (input, form, side) = (job.inputs[0], job.form, self.block_size);
        let (height, width) = (input.form().height(), input.form().width());
        let channels = form.shape()[1];
        with_element_type!(form.encoding().element, T => job.fill::<T>(|run, to| {
            for (place, to) in run.zip(to) {
                let (channel, y, x) = form.coordinates(place);
                let inside = y % side * side + x % side;
                let from = match self.order {
                    DepthToSpaceOrder::DepthColumnRow => inside * channels + channel,
                    DepthToSpaceOrder::ColumnRowDepth => channel * side * side + inside,
                };
                *to = input.values()[(from * height + y / side) * width + x / side];
            }
        }));
    }
}

/// Moves blocks of `side` x `side` positions into channels.
#[derive(Clone, Debug)]
pub(crate) struct SpaceToDepth {
    pub(crate) block_size: usize,
    pub(crate) order: DepthToSpaceOrder,
}

impl Operator for SpaceToDepth {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let [channels, height, width] = feature_size(only_input(inputs)?)?;
        let side = self.block_size;
        if height % side != 0 || width % side != 0 {
            return Err(format!(
                "{width}x{height} positions do not consist of squares of {side}x{side}"
            ));
        }
        let channels = channels.checked_mul(side * side).ok_or("it has too many channels")?;
        Ok(TensorForm::features(vec![1, channels, height / side, width / side]))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved_encoding(inputs)
    }

    fn axis_windows(&self) -> Option<[AxisWindow; 2]> {
        Some(
            [AxisWindow { kernel: self.block_size, stride: self.block_size, ..AxisWindow::SAME };
                2],
        )
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let (input, form, side) = (job.inputs[0], job.form, self.block_size);
        let (channels, width) = (input.form().shape()[1], input.form().width());
        let places = input.form().position_count();
        with_element_type!(form.encoding().element, T => job.fill::<T>(|run, to| {
            for (place, to) in run.zip(to) {
                let (channel, y, x) = form.coordinates(place);
                let (square, channel) = match self.order {
                    DepthToSpaceOrder::DepthColumnRow => (channel / channels, channel % channels),
                    DepthToSpaceOrder::ColumnRowDepth => (channel % (side * side), channel / (side * side)),
                };
                let (y, x) = (y * side + square / side, x * side + square % side);
                *to = input.values()[channel * places + y * width + x];
            }
        }));
    }
}
