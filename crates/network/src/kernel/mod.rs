// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inner loops of convolutions. Every output is summed in one fixed order, whichever thread
//! computes it and whichever outputs are computed with it, so that a part of a tensor has the same
//! bits as in a complete computation.

mod blocking;
mod byte_convolution;
mod chunks;
mod depthwise;
mod gathered_inputs;
mod micro_kernel;
mod output_areas;
mod panels;
mod thread_parts;

pub(crate) use blocking::BlockSizes;
pub(crate) use byte_convolution::{
    DepthwiseByteTask, MAX_EXACT_PRODUCTS, PackedByteWeights, convolve_bytes,
};
pub(crate) use chunks::{CHUNK_POSITIONS, PositionChunk, chunks_of_flat_mask, chunks_of_mask};
pub(crate) use depthwise::{AreaBuffers, AreaLayout, DepthwiseChannel};
pub(crate) use gathered_inputs::ConvInput;
pub(crate) use output_areas::areas_of_chunks;
pub(crate) use panels::{ConvOutputs, PackedWeights, convolve, scheduled_positions};
pub(crate) use thread_parts::thread_parts;
