// SPDX-License-Identifier: MIT OR Apache-2.0
//! NumPy arrays as files: written as they grow frame by frame, and read. Knows nothing of what the values are.

mod element;
mod reader;
mod writer;

pub use element::Element;
pub use reader::{NpyArray, NpyError, read};
pub use writer::{NpyWriter, header};
