// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outputs of a node, as they are read.

use super::constant::Constant;
use super::node::{GraphValue, Operand};
use crate::activation::Activation;
use crate::operator::Operator;
use std::sync::Arc;

/// An output of a node.
pub(super) enum NodeOutput {
    Constant(Constant),
    /// The output is an input of the node.
    Alias(GraphValue),
    Operator(Arc<dyn Operator>, Vec<Operand>),
    /// The output is an activation of a tensor. The operator that makes the tensor may apply it.
    Activated(Activation, usize),
}

/// Returns one output, which an operator makes of these tensors.
pub(super) fn output_of_tensors(
    operator: impl Operator + 'static,
    inputs: Vec<usize>,
) -> Result<Vec<NodeOutput>, String> {
    output_of_operands(operator, inputs.into_iter().map(Operand::Tensor).collect())
}

/// Returns one output, which an operator makes of tensors and constants.
pub(super) fn output_of_operands(
    operator: impl Operator + 'static,
    operands: Vec<Operand>,
) -> Result<Vec<NodeOutput>, String> {
    Ok(vec![NodeOutput::Operator(Arc::new(operator), operands)])
}
