// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rearranges channels into blocks of neighboring positions (`DepthToSpace`) and back
//! (`SpaceToDepth`).

use super::{Operator, OperatorJob, feature_size, moved_encoding, only_input};
use crate::element::{Encoding, with_element_type};
use crate::mask::{AxisWindow, Mask};
use crate::tensor_form::TensorForm;

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
