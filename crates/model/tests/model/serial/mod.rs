// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the serial array against outputs that are computed step by step from `docs/serial.md`
//! and the oracle, against the functional camera, and against the pipelined array.

mod bench;
mod camera;
mod examples;
mod expected_outputs;
mod planted_faults;
mod properties;
mod serial_parameters;
mod streams;
mod zones;
