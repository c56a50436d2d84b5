// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution of 8-bit values. Its sums are exact, and are either kept or requantized to 8 bits.

use super::quantization::{Requantization, SumOutput};
use super::{ConvGeometry, Operator, OperatorJob, ProductKind, encoding_from_bytes, output_values};
use crate::element::{ElementType, Encoding, with_byte_type};
use crate::kernel::{
    self, BlockSizes, CHUNK_POSITIONS, ConvInput, ConvOutputs, DepthwiseByteTask,
    MAX_EXACT_PRODUCTS, PackedByteWeights, PositionChunk, chunks_of_mask,
};
use crate::mask::Mask;
use crate::tensor::TensorForm;
use crate::threads;
use crate::values::ByteNumber;
use foveate_pixels::vectors::InstructionSet;

/// Weights of 8 bits, with one row per channel. Unsigned weights and their zero points are stored
/// less 128.
#[derive(Clone, Debug)]
pub(crate) struct ByteWeightRows {
    pub(crate) values: Vec<i8>,
    /// One zero point per channel.
    pub(crate) zero_points: Vec<i8>,
}

impl ByteWeightRows {
    pub(crate) fn byte_count(&self) -> u64 {
        (self.values.len() + self.zero_points.len()) as u64
    }
}

#[derive(Clone, Debug)]
pub(crate) struct IntegerConv {
    geometry: ConvGeometry,
    level: InstructionSet,
    kernels: IntegerConvKernels,
    weights: u64,
    /// The zero point of the input, which is also its padding.
    zero_point: i32,
    sums: Requantization,
}

#[derive(Clone, Debug)]
enum IntegerConvKernels {
    Depthwise(ByteWeightRows),
    Groups(Vec<PackedByteWeights>),
}

impl IntegerConv {
    pub(crate) fn new(
        geometry: ConvGeometry,
        rows: ByteWeightRows,
        zero: i32,
        sums: Requantization,
        level: InstructionSet,
    ) -> Result<Self, String> {
        geometry.check_bias(Some(sums.bias.as_slice()).filter(|bias| !bias.is_empty()))?;
        let weights = rows.byte_count() + sums.bytes();
        let kernels = if geometry.is_depthwise() {
            IntegerConvKernels::Depthwise(rows)
        } else if geometry.columns.kernel > MAX_EXACT_PRODUCTS {
            return Err(format!(
                "its kernel has {} columns; at most {MAX_EXACT_PRODUCTS} are supported for 8-bit values",
                geometry.columns.kernel
            ));
        } else {
            let (depth, of_group) = (geometry.depth(), geometry.output_channels / geometry.groups);
            let pack = |(rows, zeros)| {
                PackedByteWeights::new(rows, depth, zeros, BlockSizes::for_instruction_set(level))
            };
            let groups =
                rows.values.chunks(of_group * depth).zip(rows.zero_points.chunks(of_group));
            IntegerConvKernels::Groups(groups.map(pack).collect())
        };
        Ok(Self { geometry, level, kernels, weights, zero_point: zero, sums })
    }

    fn convolve<X: ByteNumber, Y: SumOutput>(&self, job: OperatorJob<'_>) {
        let chunks = chunks_of_mask(job.positions);
        if chunks.is_empty() {
            return;
        }
        let OperatorJob { inputs, form, output, .. } = job;
        let (height, width) = (inputs[0].form().height(), inputs[0].form().width());
        let ConvGeometry { rows, columns, groups, output_channels: channels, input_channels: all } =
            self.geometry;
        let (of_group, seen) = (channels / groups, all / groups * height * width);
        let picture = |group: usize| ConvInput {
            values: &inputs[0].values::<X>()[group * seen..][..seen],
            height,
            width,
            rows,
            columns,
            padding: X::from_saturated(self.zero_point),
        };
        let (outputs, length) =
            (output_values::<Y>(output, form), of_group * form.position_count());
        match &self.kernels {
            IntegerConvKernels::Depthwise(weights) => {
                threads::for_each_chunk(outputs, length, &|channel, outputs| {
                    let taps = rows.kernel * columns.kernel;
                    let mut sums = vec![[0; CHUNK_POSITIONS]; chunks.len()];
                    self.level.run(DepthwiseByteTask {
                        picture: picture(channel),
                        weights: (
                            &weights.values[channel * taps..][..taps],
                            weights.zero_points[channel],
                        ),
                        chunks: &chunks,
                        sums: &mut sums,
                    });
                    for (chunk, sums) in chunks.iter().zip(sums) {
                        let row = &mut outputs[chunk.y * form.width()..][chunk.x..form.width()];
                        for (output, sum) in row.iter_mut().zip(sums) {
                            *output = self.sums.requantize(channel, sum);
                        }
                    }
                });
            }
            IntegerConvKernels::Groups(kernels) => {
                threads::for_each_chunk(outputs, length, &|group, values| {
                    let (weights, picture) = (&kernels[group], picture(group));
                    let finish =
                        |channel, sum| self.sums.requantize(group * of_group + channel, sum);
                    let part = |(chunks, outputs): (&[PositionChunk], ConvOutputs<'_, Y>)| {
                        kernel::convolve_bytes(
                            self.level, &picture, weights, chunks, outputs, finish,
                        );
                    };
                    let blocks = weights.packed().blocks();
                    let parts = kernel::thread_parts(
                        blocks,
                        &chunks,
                        values,
                        [form.height(), form.width()],
                    );
                    threads::for_each_part(parts, &part);
                });
            }
        }
    }
}

impl Operator for IntegerConv {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        self.geometry.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        encoding_from_bytes(inputs, self.sums.to)
    }

    fn compute(&self, job: OperatorJob<'_>) {
        with_byte_type!(job.inputs[0].form().encoding().element, X => {
            match self.sums.to.element {
                ElementType::U8 => self.convolve::<X, u8>(job),
                ElementType::I8 => self.convolve::<X, i8>(job),
                ElementType::I32 => self.convolve::<X, i32>(job),
                ElementType::F32 => unreachable!("a convolution of integers makes integers"),
            }
        });
    }

    fn products(&self) -> ProductKind {
        self.geometry.products()
    }

    fn scheduled_positions(&self, at: &Mask) -> usize {
        let chunks = chunks_of_mask(at).len();
        match &self.kernels {
            IntegerConvKernels::Depthwise(_) => chunks * CHUNK_POSITIONS,
            IntegerConvKernels::Groups(groups) => {
                kernel::scheduled_positions(chunks, groups[0].packed().blocking())
            }
        }
    }

    fn weight_bytes(&self) -> u64 {
        self.weights
    }
}
