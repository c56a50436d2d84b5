// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution of 8-bit values. Its sums are exact, and are either kept or requantized to 8 bits.

use super::sums::{Outcome, Sums};
use super::{Geometry, Job, Operator, Products, of_bytes, values_of};
use crate::element::{Element, Encoding, typed_byte};
use crate::form::Form;
use crate::kernel::{
    self, Blocking, ByteWeights, CHUNK, Chunk, DepthwiseBytes, EXACT, Outputs, Picture, chunks,
};
use crate::mask::Mask;
use crate::threads;
use crate::values::Byte;
use foveate_lanes::Level;

/// Weights of 8 bits, with one row per channel. Unsigned weights and their zero points are stored
/// less 128.
#[derive(Clone, Debug)]
pub(crate) struct Rows {
    pub(crate) values: Vec<i8>,
    /// One zero point per channel.
    pub(crate) zeros: Vec<i8>,
}

impl Rows {
    pub(crate) fn bytes(&self) -> u64 {
        (self.values.len() + self.zeros.len()) as u64
    }
}

#[derive(Clone, Debug)]
pub(crate) struct IntegerConv {
    geometry: Geometry,
    level: Level,
    kernels: Kernels,
    weights: u64,
    /// The zero point of the input, which is also its padding.
    zero: i32,
    sums: Sums,
}

#[derive(Clone, Debug)]
enum Kernels {
    Depthwise(Rows),
    Groups(Vec<ByteWeights>),
}

impl IntegerConv {
    pub(crate) fn new(
        geometry: Geometry,
        rows: Rows,
        zero: i32,
        sums: Sums,
        level: Level,
    ) -> Result<Self, String> {
        geometry.check_bias(Some(sums.bias.as_slice()).filter(|bias| !bias.is_empty()))?;
        let weights = rows.bytes() + sums.bytes();
        let kernels = if geometry.is_depthwise() {
            Kernels::Depthwise(rows)
        } else if geometry.columns.kernel > EXACT {
            return Err(format!(
                "its kernel has {} columns; of 8-bit values at most {EXACT} are supported",
                geometry.columns.kernel
            ));
        } else {
            let (depth, of_group) = (geometry.depth(), geometry.channels / geometry.groups);
            let pack = |(rows, zeros)| ByteWeights::new(rows, depth, zeros, Blocking::of(level));
            let groups = rows.values.chunks(of_group * depth).zip(rows.zeros.chunks(of_group));
            Kernels::Groups(groups.map(pack).collect())
        };
        Ok(Self { geometry, level, kernels, weights, zero, sums })
    }

    fn convolve<X: Byte, Y: Outcome>(&self, job: Job<'_>) {
        let chunks = chunks(job.at);
        if chunks.is_empty() {
            return;
        }
        let Job { inputs, form, output, .. } = job;
        let (height, width) = (inputs[0].form().height(), inputs[0].form().width());
        let Geometry { rows, columns, groups, channels, inputs: all } = self.geometry;
        let (of_group, seen) = (channels / groups, all / groups * height * width);
        let picture = |group: usize| Picture {
            values: &inputs[0].values::<X>()[group * seen..][..seen],
            height,
            width,
            rows,
            columns,
            padding: X::saturated(self.zero),
        };
        let (outputs, length) = (values_of::<Y>(output, form), of_group * form.places());
        match &self.kernels {
            Kernels::Depthwise(weights) => {
                threads::each_chunk(outputs, length, &|channel, outputs| {
                    let taps = rows.kernel * columns.kernel;
                    let mut sums = vec![[0; CHUNK]; chunks.len()];
                    self.level.run(DepthwiseBytes {
                        picture: picture(channel),
                        weights: (
                            &weights.values[channel * taps..][..taps],
                            weights.zeros[channel],
                        ),
                        chunks: &chunks,
                        sums: &mut sums,
                    });
                    for (chunk, sums) in chunks.iter().zip(sums) {
                        let row = &mut outputs[chunk.y * form.width()..][chunk.x..form.width()];
                        for (output, sum) in row.iter_mut().zip(sums) {
                            *output = self.sums.finish(channel, sum);
                        }
                    }
                });
            }
            Kernels::Groups(kernels) => threads::each_chunk(outputs, length, &|group, values| {
                let (weights, picture) = (&kernels[group], picture(group));
                let finish = |channel, sum| self.sums.finish(group * of_group + channel, sum);
                let part = |(chunks, outputs): (&[Chunk], Outputs<'_, Y>)| {
                    kernel::convolve_bytes(self.level, &picture, weights, chunks, outputs, finish);
                };
                let blocks = weights.packed().blocks();
                let parts = kernel::parts(blocks, &chunks, values, [form.height(), form.width()]);
                threads::each_part(parts, &part);
            }),
        }
    }
}

impl Operator for IntegerConv {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        self.geometry.form(inputs)
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        of_bytes(inputs, self.sums.to)
    }

    fn compute(&self, job: Job<'_>) {
        typed_byte!(job.inputs[0].form().encoding().element, X => {
            match self.sums.to.element {
                Element::U8 => self.convolve::<X, u8>(job),
                Element::I8 => self.convolve::<X, i8>(job),
                Element::I32 => self.convolve::<X, i32>(job),
                Element::F32 => unreachable!("a convolution of integers makes integers"),
            }
        });
    }

    fn products(&self) -> Products {
        self.geometry.products()
    }

    fn scheduled(&self, at: &Mask) -> usize {
        let chunks = chunks(at).len();
        match &self.kernels {
            Kernels::Depthwise(_) => chunks * CHUNK,
            Kernels::Groups(groups) => kernel::scheduled(chunks, groups[0].packed().blocking()),
        }
    }

    fn weight_bytes(&self) -> u64 {
        self.weights
    }
}
