// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the outputs of a node are.

use super::constant::Constant;
use super::node::Known;
use crate::operator::{Activation, Operator};
use std::sync::Arc;

/// What an output of a node is.
pub(super) enum Made {
    Constant(Constant),
    /// What an input is.
    Same(Known),
    Operator(Arc<dyn Operator>, Vec<usize>),
    /// An activation of a value, which the operator that makes it may apply itself.
    Finish(Activation, usize),
}

/// One output, which an operator makes of these values.
pub(super) fn one(
    operator: impl Operator + 'static,
    inputs: Vec<usize>,
) -> Result<Vec<Made>, String> {
    Ok(vec![Made::Operator(Arc::new(operator), inputs)])
}
