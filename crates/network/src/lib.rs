// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads ONNX networks and runs them over frames of which only a part has changed.
//!
//! A [`Network`] is read from an ONNX file. An [`Executor`] runs it frame by frame and keeps every
//! tensor. It takes the positions of the frame that may have changed, derives from them layer by
//! layer the positions of each tensor that may have changed (a [`Mask`]), and computes only these.
//! In the exact [`Mode`]s the result is equal to that of a dense computation bit for bit: each
//! value is summed in one fixed order, whichever positions are computed.
//!
//! [`sight`] converts frames to the input of a network and reads detections from its outputs.

mod compare;
mod element;
mod error;
mod evaluate;
mod executor;
mod form;
mod kernel;
mod layout;
mod mask;
mod moment;
mod network;
pub mod onnx;
mod operator;
mod read;
pub mod sight;
mod tensor;
mod threads;
mod values;

pub use element::{Element, Encoding};
pub use error::NetworkError;
pub use evaluate::{NetworkEvaluation, evaluate};
pub use executor::{Executor, Mode, Work};
pub use form::Form;
pub use layout::Layout;
pub use mask::{Mask, Window};
pub use network::{Network, Node};
pub use operator::Products;
pub use read::{FrameSize, NetworkCheck, operators};
pub use tensor::Tensor;
