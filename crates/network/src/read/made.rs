// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outputs of a node, as they are read.

use super::constant::Constant;
use super::node::{Known, Operand};
use crate::operator::{Activation, Operator};
use std::sync::Arc;

/// An output of a node.
pub(super) enum Made {
    Constant(Constant),
    /// The output is an input of the node.
    Same(Known),
    Operator(Arc<dyn Operator>, Vec<Operand>),
    /// The output is an activation of a tensor. The operator that makes the tensor may apply it.
    Finish(Activation, usize),
}

/// Returns one output, which an operator makes of these tensors.
pub(super) fn one(
    operator: impl Operator + 'static,
    inputs: Vec<usize>,
) -> Result<Vec<Made>, String> {
    of(operator, inputs.into_iter().map(Operand::Value).collect())
}

/// Returns one output, which an operator makes of tensors and constants.
pub(super) fn of(
    operator: impl Operator + 'static,
    operands: Vec<Operand>,
) -> Result<Vec<Made>, String> {
    Ok(vec![Made::Operator(Arc::new(operator), operands)])
}
