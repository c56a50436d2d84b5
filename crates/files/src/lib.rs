// SPDX-License-Identifier: MIT OR Apache-2.0
//! How results are kept: NumPy arrays that grow frame by frame, and tables. Knows nothing of what they are about.

pub mod npy;
pub mod tables;
