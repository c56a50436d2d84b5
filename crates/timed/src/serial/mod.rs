// SPDX-License-Identifier: MIT OR Apache-2.0
//! A serial array, by `docs/serial.md`.

mod array;

pub(crate) use array::SerialCore;
