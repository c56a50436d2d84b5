// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the serial array against outputs that are computed step by step from `docs/serial.md`
//! and the oracle, and against the pipelined array.

mod bench;
mod examples;
mod expected_outputs;
mod matrix;
mod properties;
mod serial_parameters;
mod streams;
