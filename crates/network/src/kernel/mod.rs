// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inner loops of convolutions. Every output is summed in one fixed order, whichever thread
//! computes it and whichever outputs are computed with it, so that a part of a tensor has the same
//! bits as in a complete computation.

mod areas;
mod blocking;
mod chunks;
mod depthwise;
mod gather;
mod integer;
mod micro;
mod panels;
mod parts;
mod weights;

pub(crate) use areas::areas;
pub(crate) use blocking::Blocking;
pub(crate) use chunks::{CHUNK, Chunk, chunks, chunks_in_a_row};
pub(crate) use depthwise::{Depthwise, Layout, Planes};
pub(crate) use gather::Picture;
pub(crate) use integer::{ByteWeights, DepthwiseBytes, EXACT, convolve_bytes};
pub(crate) use panels::{Outputs, convolve, scheduled};
pub(crate) use parts::parts;
pub(crate) use weights::Weights;
