// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rearranges channels into blocks of neighboring positions (`DepthToSpace`) and back
//! (`SpaceToDepth`).

use super::{Job, Operator, features, moved, only};
use crate::element::{Encoding, typed};
use crate::form::Form;
use crate::mask::{Mask, Window};

/// The order of the channels that hold one block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// The index in the block varies slowest: mode `DCR` of ONNX.
    SquareFirst,
    /// The channel varies slowest: mode `CRD` of ONNX.
    ChannelFirst,
}

/// Moves channels into blocks of `side` x `side` positions.
#[derive(Clone, Debug)]
pub(crate) struct DepthToSpace {
    pub(crate) side: usize,
    pub(crate) order: Order,
}

impl Operator for DepthToSpace {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let [channels, height, width] = features(only(inputs)?)?;
        let square = self.side * self.side;
        if channels % square != 0 {
            return Err(format!("{channels} channels are not squares of {square}"));
        }
        Ok(Form::features(vec![1, channels / square, height * self.side, width * self.side]))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved(inputs)
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        let sources = |outputs: usize| -> Vec<(usize, usize)> {
            (0..outputs).map(|at| (at / self.side, at / self.side)).collect()
        };
        inputs[0].1.between(&sources(output.height()), &sources(output.width()))
    }

    fn takes_features(&self) -> bool {
        true
    }

    fn compute(&self, job: Job<'_>) {
        let (input, form, side) = (job.inputs[0], job.form, self.side);
        let (height, width) = (input.form().height(), input.form().width());
        let channels = form.shape()[1];
        typed!(form.encoding().element, T => job.fill::<T>(|run, to| {
            for (place, to) in run.zip(to) {
                let (channel, y, x) = form.coordinates(place);
                let inside = y % side * side + x % side;
                let from = match self.order {
                    Order::SquareFirst => inside * channels + channel,
                    Order::ChannelFirst => channel * side * side + inside,
                };
                *to = input.values()[(from * height + y / side) * width + x / side];
            }
        }));
    }
}

/// Moves blocks of `side` x `side` positions into channels.
#[derive(Clone, Debug)]
pub(crate) struct SpaceToDepth {
    pub(crate) side: usize,
    pub(crate) order: Order,
}

impl Operator for SpaceToDepth {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let [channels, height, width] = features(only(inputs)?)?;
        let side = self.side;
        if height % side != 0 || width % side != 0 {
            return Err(format!("{width}x{height} places are not squares of {side}x{side}"));
        }
        let channels = channels.checked_mul(side * side).ok_or("it has too many channels")?;
        Ok(Form::features(vec![1, channels, height / side, width / side]))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved(inputs)
    }

    fn windows(&self) -> Option<[Window; 2]> {
        Some([Window { kernel: self.side, stride: self.side, ..Window::SAME }; 2])
    }

    fn compute(&self, job: Job<'_>) {
        let (input, form, side) = (job.inputs[0], job.form, self.side);
        let (channels, width) = (input.form().shape()[1], input.form().width());
        let places = input.form().places();
        typed!(form.encoding().element, T => job.fill::<T>(|run, to| {
            for (place, to) in run.zip(to) {
                let (channel, y, x) = form.coordinates(place);
                let (square, channel) = match self.order {
                    Order::SquareFirst => (channel / channels, channel % channels),
                    Order::ChannelFirst => (channel % (side * side), channel / (side * side)),
                };
                let (y, x) = (y * side + square / side, x * side + square % side);
                *to = input.values()[channel * places + y * width + x];
            }
        }));
    }
}
