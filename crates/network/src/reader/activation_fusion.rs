// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fusion of activations with the operators whose outputs they take.

use super::graph::GraphReader;
use super::node::{GraphValue, full_operator_name};
use super::pointwise_operators;
use crate::activation::Activation;
use crate::onnx::NodeProto;

impl GraphReader<'_> {
    /// Lets the operator of the last node apply an activation, if no other node takes its output.
    /// Returns the tensor, or `None` if the activation cannot be fused.
    pub(super) fn fuse_activation(
        &mut self,
        kind: &str,
        activation: Activation,
        value: usize,
        input: &str,
    ) -> Option<usize> {
        let is_alone = value == self.network.nodes().len()
            && self.use_counts.get(input) == Some(&1)
            && !self.aliased_tensors.contains(&value);
        let last = self.network.nodes().last().filter(|_| is_alone)?;
        let operator = last.operator.with_activation(activation)?;
        let fused = format!("{}+{kind}", last.operator_name());
        self.network.replace_last(&fused, operator);
        Some(value)
    }

    /// Replaces the product of a tensor with its `Sigmoid`, which must be the last node, by one
    /// activation. The operator of the tensor applies the activation if it can and if no other node
    /// takes its output. Returns the resulting tensor, or `None` if the node is no such product.
    pub(super) fn fuse_swish(&mut self, node: &NodeProto) -> Option<usize> {
        let ([a, b], [_]) = (node.input.as_slice(), node.output.as_slice()) else { return None };
        let value = |name: &str| match self.values.get(name) {
            Some(&GraphValue::Tensor(value)) => Some(value),
            Some(GraphValue::Constant(_)) | None => None,
        };
        let (of_a, of_b) = (value(a)?, value(b)?);
        let gate = self.network.nodes().len();
        let (input, input_name, gate_name) = match (of_a, of_b) {
            (input, other) if other == gate => (input, a, b),
            (other, input) if other == gate => (input, b, a),
            _ => return None,
        };
        let last = self.network.nodes().last()?;
        let is_swish = full_operator_name(node) == "Mul"
            && last.operator_name() == "Sigmoid"
            && last.inputs() == [input]
            && self.use_counts.get(gate_name.as_str()) == Some(&1)
            && !self.aliased_tensors.contains(&gate);
        if !is_swish {
            return None;
        }
        let swish = Activation::Swish { alpha: 1.0 };
        let is_alone = input > 0
            && input + 1 == gate
            && self.use_counts.get(input_name.as_str()) == Some(&2)
            && !self.aliased_tensors.contains(&input);
        let before = is_alone.then(|| &self.network.nodes()[input - 1]);
        let finished = before.and_then(|before| {
            Some((before.operator_name(), before.operator.with_activation(swish)?))
        });
        match finished {
            Some((kind, operator)) => {
                let kind = format!("{kind}+Sigmoid+Mul");
                self.network.remove_last();
                self.network.replace_last(&kind, operator);
                Some(input)
            }
            None => {
                self.network
                    .replace_last("Sigmoid+Mul", pointwise_operators::activation_operator(swish));
                Some(gate)
            }
        }
    }
}
