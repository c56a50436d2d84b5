// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the outputs of a node are.

use super::constant::Constant;
use super::node::{Known, Operand};
use crate::operator::{Activation, Operator};
use std::sync::Arc;

/// What an output of a node is.
pub(super) enum Made {
    Constant(Constant),
    /// What an input is.
    Same(Known),
    Operator(Arc<dyn Operator>, Vec<Operand>),
    /// An activation of a value, which the operator that makes it may apply itself.
    Finish(Activation, usize),
}

/// One output, which an operator makes of these values.
pub(super) fn one(
    operator: impl Operator + 'static,
    inputs: Vec<usize>,
) -> Result<Vec<Made>, String> {
    of(operator, inputs.into_iter().map(Operand::Value).collect())
}

/// One output, which an operator makes of values and constants.
pub(super) fn of(
    operator: impl Operator + 'static,
    operands: Vec<Operand>,
) -> Result<Vec<Made>, String> {
    Ok(vec![Made::Operator(Arc::new(operator), operands)])
}
