// SPDX-License-Identifier: MIT OR Apache-2.0
//! NumPy arrays as files that grow frame by frame. Knows nothing of what the values are.

mod element;
mod writer;

pub use element::Element;
pub use writer::{NpyWriter, header};
