// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads ONNX networks and runs them over frames of which only a part has changed.
//!
//! A [`Network`] is read from an ONNX file. An [`Executor`] runs it frame by frame and keeps every
//! tensor. It takes the positions of the frame that may have changed, derives from them layer by
//! layer the positions of each tensor that may have changed (a [`Mask`]), and computes only these.
//! In the exact [`ExecutionMode`]s the result is equal to that of a dense computation bit for bit:
//! each value is summed in one fixed order, whichever positions are computed.
//!
//! [`vision`] converts frames to the input of a network and reads detections from its outputs.
//! [`accelerator`] knows what layers cost on an accelerator.

pub mod accelerator;
mod activation;
mod comparison;
mod element;
mod error;
mod evaluation;
mod executor;
mod kernel;
mod mask;
mod network;
pub mod onnx;
mod operator;
mod optional_instant;
mod reader;
mod tensor;
mod threads;
mod values;
pub mod vision;

pub use element::{ElementType, Encoding};
pub use error::NetworkError;
pub use evaluation::{NetworkEvaluation, evaluate};
pub use executor::{ExecutionMode, Executor, NodeWork};
pub use mask::{AxisWindow, Mask};
pub use network::{Network, NetworkNode};
pub use operator::ProductKind;
pub use reader::{FrameSize, NetworkCheck, OpenFile, operators};
pub use tensor::{InputLayout, Tensor, TensorForm};
