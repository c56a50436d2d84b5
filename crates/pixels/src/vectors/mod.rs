// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pixels in vector elements, shared by the engine and the executor of networks.
//!
//! * [`InstructionSet`]: a set of vector instructions that is chosen at run time. A [`VectorTask`]
//!   is compiled once per level. A [`PanelTask`] is also compiled for the panel size of that level.
//! * [`VectorPixel`]: a pixel as a byte or a word, with the arithmetic on it that vectorizes.
//!   [`Block`]: the elements of one full register.
//! * [`AlignedBuffer`]: a buffer whose blocks are cache lines.
//! * [`best_arc`]: FAST 5/8 as a network of minima and maxima.

mod instruction_set;
mod vector_pixel;

pub use instruction_set::{InstructionSet, PanelTask, VectorTask, prefetch};
pub use vector_pixel::{
    AlignedBuffer, BLOCK_LENGTH, Block, VectorPixel, best_arc, saturated_threshold,
};
