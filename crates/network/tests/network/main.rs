// SPDX-License-Identifier: MIT OR Apache-2.0
//! Networks are built as ONNX bytes and run in every mode.
#![allow(clippy::unwrap_used, reason = "tests")]

mod activations;
mod attributes;
mod documents;
mod exactness;
mod golden_denoiser;
mod integer_layers;
mod integers;
mod layout;
mod model;
mod reference_formulas;
mod rejected_models;
mod torch_networks;
mod trained_networks;
