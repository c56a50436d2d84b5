// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution ([`Conv`]) with groups, strides, dilation and padding. Its windows and channels
//! do not depend on the type of its values ([`ConvGeometry`]).

use super::{Operator, OperatorJob, ProductKind, feature_size, only_input, output_values};
use crate::activation::Activation;
use crate::kernel::{
    self, AreaBuffers, AreaLayout, BlockSizes, CHUNK_POSITIONS, ConvInput, ConvOutputs,
    DepthwiseChannel, PackedWeights, PositionChunk, areas_of_chunks, chunks_of_flat_mask,
    chunks_of_mask,
};
use crate::mask::{AxisWindow, Mask};
use crate::tensor::TensorForm;
use crate::threads;
use foveate_pixels::vectors::InstructionSet;
use std::sync::Arc;

/// A convolution of floating-point values.
#[derive(Clone, Debug)]
pub(crate) struct Conv {
    geometry: ConvGeometry,
    level: InstructionSet,
    kernels: ConvKernels,
    weight_bytes: u64,
    activation: Activation,
}

#[derive(Clone, Debug)]
enum ConvKernels {
    Depthwise { weights: Vec<f32>, bias: Vec<f32> },
    Groups(Vec<PackedWeights>),
}

impl Conv {
    /// Returns a convolution with `weights` in the order
    /// `[channels, inputs per group, rows, columns]`.
    pub(crate) fn new(
        geometry: ConvGeometry,
        weights: &[f32],
        bias: Option<&[f32]>,
        level: InstructionSet,
    ) -> Result<Self, String> {
        geometry.check_bias(bias)?;
        let (channels, depth) = (geometry.output_channels, geometry.depth());
        let bias = bias.map_or_else(|| vec![0.0; channels], <[f32]>::to_vec);
        let kernels = if geometry.is_depthwise() {
            ConvKernels::Depthwise { weights: weights.to_vec(), bias }
        } else {
            let of_group = channels / geometry.groups;
            let pack = |(rows, bias)| {
                PackedWeights::new(rows, depth, bias, BlockSizes::for_instruction_set(level))
            };
            let groups = weights.chunks(of_group * depth).zip(bias.chunks(of_group));
            ConvKernels::Groups(groups.map(pack).collect())
        };
        let weights = 4 * (weights.len() + channels) as u64;
        Ok(Self {
            geometry,
            level,
            kernels,
            weight_bytes: weights,
            activation: Activation::Identity,
        })
    }
}

impl Operator for Conv {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        self.geometry.form(inputs)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        let chunks = self.chunks(job.positions);
        if chunks.is_empty() {
            return;
        }
        self.convolve(job, &chunks);
    }

    fn products(&self) -> ProductKind {
        self.geometry.products()
    }

    fn scheduled_positions(&self, at: &Mask) -> usize {
        let chunks = self.chunks(at).len();
        match &self.kernels {
            ConvKernels::Depthwise { .. } => chunks * CHUNK_POSITIONS,
            ConvKernels::Groups(groups) => {
                kernel::scheduled_positions(chunks, groups[0].blocking())
            }
        }
    }

    fn with_activation(&self, finish: Activation) -> Option<Arc<dyn Operator>> {
        let is_free = self.activation == Activation::Identity;
        is_free.then(|| Arc::new(Self { activation: finish, ..self.clone() }) as Arc<dyn Operator>)
    }

    fn weight_bytes(&self) -> u64 {
        self.weight_bytes
    }
}

impl Conv {
    /// The chunks of the positions that are computed.
    fn chunks(&self, at: &Mask) -> Vec<PositionChunk> {
        if self.geometry.is_pointwise() { chunks_of_flat_mask(at) } else { chunks_of_mask(at) }
    }

    fn convolve(&self, job: OperatorJob<'_>, chunks: &[PositionChunk]) {
        let activation = self.activation;
        let OperatorJob { inputs, form, output, .. } = job;
        let output: &mut [f32] = output_values(output, form);
        let [height, width] = self.geometry.computed_size(inputs[0].form());
        let size = self.geometry.computed_size(form);
        let places = form.position_count();
        let ConvGeometry { rows, columns, groups, output_channels: channels, input_channels: all } =
            self.geometry;
        let of_group = all / groups * height * width;
        let picture = |group: usize| ConvInput {
            values: &inputs[0].values()[group * of_group..][..of_group],
            height,
            width,
            rows,
            columns,
            padding: 0.0,
        };
        match &self.kernels {
            ConvKernels::Depthwise { weights, bias } => {
                let taps = rows.kernel * columns.kernel;
                let layout = |area| AreaLayout::new(area, rows, columns);
                let layouts: &Vec<_> =
                    &areas_of_chunks(chunks, size[1]).into_iter().map(layout).collect();
                let channel = |planes: &mut AreaBuffers, channel: usize, outputs: &mut [f32]| {
                    let (weights, bias) = (&weights[channel * taps..][..taps], bias[channel]);
                    let (picture, width) = (picture(channel), size[1]);
                    DepthwiseChannel {
                        picture,
                        weights,
                        bias,
                        layouts,
                        outputs,
                        width,
                        activation,
                    }
                    .convolve(self.level, planes);
                };
                threads::for_each_chunk_with_scratch(output, places, &channel);
            }
            ConvKernels::Groups(kernels) => {
                let of_group = channels / groups;
                let planes = output.chunks_mut(of_group * places);
                for (group, (weights, values)) in kernels.iter().zip(planes).enumerate() {
                    let picture = picture(group);
                    let part = |(chunks, outputs): (&[PositionChunk], ConvOutputs<'_>)| {
                        kernel::convolve(
                            self.level, &picture, weights, chunks, outputs, activation,
                        );
                    };
                    let blocks = weights.blocks();
                    threads::for_each_part(
                        kernel::thread_parts(blocks, chunks, values, size),
                        &part,
                    );
                }
            }
        }
    }
}

/// The windows, groups and channels of a convolution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConvGeometry {
    pub(crate) rows: AxisWindow,
    pub(crate) columns: AxisWindow,
    pub(crate) groups: usize,
    pub(crate) output_channels: usize,
    pub(crate) input_channels: usize,
}

impl ConvGeometry {
    /// Returns the geometry of a convolution with weights of the shape
    /// `[channels, inputs per group, rows, columns]`.
    pub(crate) fn new(
        shape: &[usize],
        [rows, columns]: [AxisWindow; 2],
        groups: usize,
    ) -> Result<Self, String> {
        let &[channels, inputs, height, width] = shape else {
            return Err(format!(
                "its weights have {} axes; only two-dimensional convolution is supported",
                shape.len()
            ));
        };
        if shape.contains(&0) || groups == 0 || channels % groups != 0 {
            return Err(format!("its weights {shape:?} do not fit {groups} groups"));
        }
        if rows.kernel != height || columns.kernel != width {
            return Err(format!("its kernel_shape differs from its weights, {height}x{width}"));
        }
        Ok(Self {
            rows,
            columns,
            groups,
            output_channels: channels,
            input_channels: inputs * groups,
        })
    }

    /// Fails if a bias does not have one value per channel.
    pub(crate) fn check_bias<T>(&self, bias: Option<&[T]>) -> Result<(), String> {
        match bias {
            Some(bias) if bias.len() != self.output_channels => {
                Err(format!("its bias does not have {} channels", self.output_channels))
            }
            _ => Ok(()),
        }
    }

    /// The number of products of an output.
    pub(crate) fn depth(&self) -> usize {
        self.input_channels / self.groups * self.rows.kernel * self.columns.kernel
    }

    /// Returns true if every channel of the output depends on one channel of the input, its own.
    pub(crate) fn is_depthwise(&self) -> bool {
        self.input_channels == self.groups && self.output_channels == self.groups
    }

    /// Returns true if every output sees only the inputs of its own position.
    pub(crate) fn is_pointwise(&self) -> bool {
        [self.rows, self.columns] == [AxisWindow::SAME; 2]
    }

    /// Returns the rows and columns of an input or output for the computation. A pointwise
    /// convolution is computed as one row, because it does not matter where a row ends.
    pub(crate) fn computed_size(&self, form: &TensorForm) -> [usize; 2] {
        if self.is_pointwise() { [1, form.position_count()] } else { [form.height(), form.width()] }
    }

    /// Returns the form of the output.
    pub(crate) fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let [channels, height, width] = feature_size(only_input(inputs)?)?;
        if channels != self.input_channels {
            return Err(format!(
                "it takes {} channels, but its input has {channels}",
                self.input_channels
            ));
        }
        let (height, width) =
            (output_length(self.rows, height)?, output_length(self.columns, width)?);
        Ok(TensorForm::features(vec![1, self.output_channels, height, width]))
    }

    pub(crate) fn products(&self) -> ProductKind {
        ProductKind::Convolution { rows: self.rows, columns: self.columns, groups: self.groups }
    }
}

/// Returns the number of outputs along an axis of `inputs` inputs.
pub(super) fn output_length(window: AxisWindow, inputs: usize) -> Result<usize, String> {
    let padded = inputs + window.padding_before + window.padding_after;
    let room = padded.checked_sub(window.span());
    let room = room.ok_or_else(|| {
        format!("its window of {} is larger than its input, {padded} with padding", window.span())
    })?;
    Ok(room / window.stride + 1)
}
