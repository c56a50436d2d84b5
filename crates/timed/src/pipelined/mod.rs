// SPDX-License-Identifier: MIT OR Apache-2.0
//! A pipelined array, by `docs/timing.md`. All RPUs do the same at every clock, except that they
//! decide differently.

mod array;

pub(crate) use array::PipelinedCore;
