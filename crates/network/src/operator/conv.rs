// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution with groups, strides, dilation and padding.

use super::{Activation, Geometry, Job, Operator, Products, values_of};
use crate::form::Form;
use crate::kernel::{
    self, Blocking, CHUNK, Chunk, Depthwise, Layout, Outputs, Picture, Planes, Weights, areas,
    chunks, chunks_in_a_row,
};
use crate::mask::Mask;
use crate::threads;
use foveate_lanes::Level;
use std::sync::Arc;

/// A convolution of floating-point values.
#[derive(Clone, Debug)]
pub(crate) struct Conv {
    geometry: Geometry,
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
    /// Returns a convolution with `weights` in the order
    /// `[channels, inputs per group, rows, columns]`.
    pub(crate) fn new(
        geometry: Geometry,
        weights: &[f32],
        bias: Option<&[f32]>,
        level: Level,
    ) -> Result<Self, String> {
        geometry.check_bias(bias)?;
        let (channels, depth) = (geometry.channels, geometry.depth());
        let bias = bias.map_or_else(|| vec![0.0; channels], <[f32]>::to_vec);
        let kernels = if geometry.is_depthwise() {
            Kernels::Depthwise { weights: weights.to_vec(), bias }
        } else {
            let of_group = channels / geometry.groups;
            let pack = |(rows, bias)| Weights::new(rows, depth, bias, Blocking::of(level));
            let groups = weights.chunks(of_group * depth).zip(bias.chunks(of_group));
            Kernels::Groups(groups.map(pack).collect())
        };
        let weights = 4 * (weights.len() + channels) as u64;
        Ok(Self { geometry, level, kernels, weights, finish: Activation::Identity })
    }
}

impl Operator for Conv {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        self.geometry.form(inputs)
    }

    fn compute(&self, job: Job<'_>) {
        let chunks = self.chunks(job.at);
        if chunks.is_empty() {
            return;
        }
        // An activation that is known at compile time needs no choice in the loop.
        match self.finish {
            Activation::Identity => self.convolve(job, &chunks, |x| x),
            Activation::Relu => self.convolve(job, &chunks, |x| Activation::Relu.of(x)),
            Activation::Clip { min, max } => {
                self.convolve(job, &chunks, |x| Activation::Clip { min, max }.of(x));
            }
            Activation::Sigmoid => self.convolve(job, &chunks, |x| Activation::Sigmoid.of(x)),
            Activation::Swish { alpha } => {
                self.convolve(job, &chunks, |x| Activation::Swish { alpha }.of(x));
            }
            Activation::HardSwish => self.convolve(job, &chunks, |x| Activation::HardSwish.of(x)),
            finish => self.convolve(job, &chunks, |x| finish.of(x)),
        }
    }

    fn products(&self) -> Products {
        self.geometry.products()
    }

    fn scheduled(&self, at: &Mask) -> usize {
        let chunks = self.chunks(at).len();
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
    /// The chunks of the positions that are computed.
    fn chunks(&self, at: &Mask) -> Vec<Chunk> {
        if self.geometry.is_pointwise() { chunks_in_a_row(at) } else { chunks(at) }
    }

    fn convolve(&self, job: Job<'_>, chunks: &[Chunk], finish: impl Fn(f32) -> f32 + Copy + Sync) {
        let Job { inputs, form, output, .. } = job;
        let output: &mut [f32] = values_of(output, form);
        let [height, width] = self.geometry.size(inputs[0].form());
        let size = self.geometry.size(form);
        let places = form.places();
        let Geometry { rows, columns, groups, channels, inputs: all } = self.geometry;
        let of_group = all / groups * height * width;
        let picture = |group: usize| Picture {
            values: &inputs[0].values()[group * of_group..][..of_group],
            height,
            width,
            rows,
            columns,
            padding: 0.0,
        };
        match &self.kernels {
            Kernels::Depthwise { weights, bias } => {
                let taps = rows.kernel * columns.kernel;
                let layout = |area| Layout::new(area, rows, columns);
                let layouts: &Vec<_> = &areas(chunks, size[1]).into_iter().map(layout).collect();
                let channel = |planes: &mut Planes, channel: usize, outputs: &mut [f32]| {
                    let (weights, bias) = (&weights[channel * taps..][..taps], bias[channel]);
                    let (picture, width) = (picture(channel), size[1]);
                    Depthwise { picture, weights, bias, layouts, outputs, width, finish }
                        .convolve(self.level, planes);
                };
                threads::each_chunk_in(output, places, &channel);
            }
            Kernels::Groups(kernels) => {
                let of_group = channels / groups;
                let planes = output.chunks_mut(of_group * places);
                for (group, (weights, values)) in kernels.iter().zip(planes).enumerate() {
                    let picture = picture(group);
                    let part = |(chunks, outputs): (&[Chunk], Outputs<'_>)| {
                        kernel::convolve(self.level, &picture, weights, chunks, outputs, finish);
                    };
                    let blocks = weights.blocks();
                    threads::each_part(kernel::parts(blocks, chunks, values, size), &part);
                }
            }
        }
    }
}
