// SPDX-License-Identifier: MIT OR Apache-2.0
//! Networks are built as ONNX bytes and run in every mode.
#![allow(clippy::unwrap_used, reason = "tests")]

mod activations;
mod attributes;
mod documents;
mod exact;
mod golden;
mod integer_layers;
mod integers;
mod layout;
mod model;
mod oracle;
mod refused;
mod torch;
mod trained;
