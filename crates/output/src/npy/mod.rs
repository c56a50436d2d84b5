// SPDX-License-Identifier: MIT OR Apache-2.0
//! NumPy arrays as files, which are written frame by frame and read as a whole. The module does not
//! depend on the meaning of the values.

mod reader;
mod writer;

pub use reader::{NpyArray, NpyError, read_array};
pub use writer::{ElementType, NpyWriter, npy_header};
