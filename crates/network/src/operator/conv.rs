// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution, with groups, strides, dilation and any padding.

use super::{Activation, Job, Operator, Products, features, only};
use crate::form::Form;
use crate::kernel::{self, Blocking, CHUNK, Chunk, Depthwise, Outputs, Picture, Weights, chunks};
use crate::mask::{Mask, Window};
use foveate_lanes::Level;
use rayon::prelude::*;
use std::sync::Arc;

/// What a convolution says of itself.
#[derive(Clone, Debug)]
pub(crate) struct Conv {
    rows: Window,
    columns: Window,
    groups: usize,
    channels: usize,
    inputs: usize,
    level: Level,
    kernels: Kernels,
    weights: u64,
    finish: Activation,
}

#[derive(Clone, Debug)]
enum Kernels {
    Depthwise { weights: Vec<f32>, bias: Vec<f32> },
    Groups(Vec<Weights>),
}

impl Conv {
    /// A convolution of `weights`, which are `shape` = `[channels, inputs per group, rows, columns]`.
    pub(crate) fn new(
        shape: &[usize],
        weights: &[f32],
        bias: Option<&[f32]>,
        rows: Window,
        columns: Window,
        groups: usize,
        level: Level,
    ) -> Result<Self, String> {
        let &[channels, inputs, height, width] = shape else {
            return Err(format!(
                "its weights have {} axes; only two-dimensional convolution is known",
                shape.len()
            ));
        };
        if height == 0
            || width == 0
            || inputs == 0
            || groups == 0
            || channels == 0
            || channels % groups != 0
        {
            return Err(format!("its weights {shape:?} do not fit {groups} groups"));
        }
        if rows.kernel != height || columns.kernel != width {
            return Err(format!("its kernel_shape differs from its weights, {height}x{width}"));
        }
        if bias.is_some_and(|bias| bias.len() != channels) {
            return Err(format!("its bias is not of {channels} channels"));
        }
        let depth = inputs * height * width;
        let bias = bias.map_or_else(|| vec![0.0; channels], <[f32]>::to_vec);
        let kernels = if inputs == 1 && groups == channels {
            Kernels::Depthwise { weights: weights.to_vec(), bias }
        } else {
            let of_group = channels / groups;
            let pack = |(rows, bias)| Weights::new(rows, depth, bias, Blocking::of(level));
            let groups = weights.chunks(of_group * depth).zip(bias.chunks(of_group));
            Kernels::Groups(groups.map(pack).collect())
        };
        let weights = 4 * (weights.len() + channels) as u64;
        Ok(Self {
            rows,
            columns,
            groups,
            channels,
            inputs: inputs * groups,
            level,
            kernels,
            weights,
            finish: Activation::Identity,
        })
    }
}

impl Operator for Conv {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let [channels, height, width] = features(only(inputs)?)?;
        if channels != self.inputs {
            return Err(format!("it takes {} channels, but its input has {channels}", self.inputs));
        }
        let (height, width) = (outputs(self.rows, height)?, outputs(self.columns, width)?);
        Ok(Form::features(vec![1, self.channels, height, width]))
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        inputs[0].1.through(self.rows, self.columns, output.height(), output.width())
    }

    fn compute(&self, job: Job<'_>) {
        let chunks = chunks(job.at);
        if chunks.is_empty() {
            return;
        }
        // An activation that is known here needs no choice in the loop.
        match self.finish {
            Activation::Identity => self.convolve(job, &chunks, |x| x),
            Activation::Relu => self.convolve(job, &chunks, |x| Activation::Relu.of(x)),
            Activation::Clip { min, max } => {
                self.convolve(job, &chunks, |x| Activation::Clip { min, max }.of(x));
            }
            finish => self.convolve(job, &chunks, |x| finish.of(x)),
        }
    }

    fn products(&self) -> Products {
        Products::Convolution { rows: self.rows, columns: self.columns, groups: self.groups }
    }

    fn scheduled(&self, at: &Mask) -> usize {
        let chunks = chunks(at).len();
        match &self.kernels {
            Kernels::Depthwise { .. } => chunks * CHUNK,
            Kernels::Groups(groups) => kernel::scheduled(chunks, groups[0].blocking()),
        }
    }

    fn finished(&self, finish: Activation) -> Option<Arc<dyn Operator>> {
        let is_free = self.finish == Activation::Identity;
        is_free.then(|| Arc::new(Self { finish, ..self.clone() }) as Arc<dyn Operator>)
    }

    fn weight_bytes(&self) -> u64 {
        self.weights
    }
}

impl Conv {
    fn convolve(&self, job: Job<'_>, chunks: &[Chunk], finish: impl Fn(f32) -> f32 + Copy + Sync) {
        let Job { inputs, form, output, .. } = job;
        let (height, width) = (inputs[0].form().height(), inputs[0].form().width());
        let places = form.places();
        let of_group = self.inputs / self.groups * height * width;
        let picture = |group: usize| Picture {
            values: &inputs[0].values()[group * of_group..][..of_group],
            height,
            width,
            rows: self.rows,
            columns: self.columns,
        };
        match &self.kernels {
            Kernels::Depthwise { weights, bias } => {
                let taps = self.rows.kernel * self.columns.kernel;
                let channel = |(channel, outputs)| {
                    let (weights, bias) = (&weights[channel * taps..][..taps], bias[channel]);
                    let picture = picture(channel);
                    Depthwise {
                        picture,
                        weights,
                        bias,
                        chunks,
                        outputs,
                        width: form.width(),
                        finish,
                    }
                    .convolve(self.level);
                };
                output.par_chunks_mut(places).enumerate().for_each(channel);
            }
            Kernels::Groups(groups) => {
                let of_group = self.channels / self.groups;
                let planes = output.chunks_mut(of_group * places);
                for (group, (weights, values)) in groups.iter().zip(planes).enumerate() {
                    let picture = picture(group);
                    let part = |(chunks, outputs): (&[Chunk], Outputs<'_>)| {
                        kernel::convolve(self.level, &picture, weights, chunks, outputs, finish);
                    };
                    kernel::parts(weights, chunks, values, form).into_par_iter().for_each(part);
                }
            }
        }
    }
}

/// Outputs of a window along an axis of so many inputs.
pub(super) fn outputs(window: Window, inputs: usize) -> Result<usize, String> {
    let padded = inputs + window.before + window.after;
    let room = padded.checked_sub(window.span());
    let room = room.ok_or_else(|| {
        format!("its window of {} is larger than its input, {padded} with padding", window.span())
    })?;
    Ok(room / window.stride + 1)
}
