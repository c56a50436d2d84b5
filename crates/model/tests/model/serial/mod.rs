// SPDX-License-Identifier: MIT OR Apache-2.0
//! The serial array against waveforms that are written out step by step from `docs/serial.md` and
//! the oracle, against the functional camera, and against the pipelined array.

mod bench;
mod camera;
mod controls;
mod examples;
mod properties;
mod recipe;
mod streams;
mod waveform;
