// SPDX-License-Identifier: MIT OR Apache-2.0
//! The file formats of results: NumPy arrays that grow frame by frame, and tables. The crate does
//! not depend on the meaning of the values.

pub mod npy;
pub mod tables;
