// SPDX-License-Identifier: MIT OR Apache-2.0
//! Neural networks over frames of which only a part has changed.
//!
//! A [`Network`] is read from an ONNX file. An [`Executor`] runs it frame by frame and keeps every tensor. From the positions of the picture that
//! may have changed it derives, layer by layer, those of every tensor (a [`Mask`]), and computes these alone. In the exact [`Mode`]s the result
//! is bit for bit that of a whole computation: every value is summed in one fixed order, whoever computes it.
//!
//! [`sight`] shows it frames, and reads what it says of them.

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
