// SPDX-License-Identifier: MIT OR Apache-2.0
//! Names of nodes, operators, inputs and outputs in a model.

use crate::onnx::{FunctionProto, NodeProto, ValueInfoProto};

/// Returns true if a domain is that of the ONNX standard.
pub(super) fn is_standard(domain: Option<&str>) -> bool {
    matches!(domain, None | Some("" | "ai.onnx"))
}

/// Returns the name of an operator, with its domain if that is not the standard one.
pub(super) fn full_operator_name(node: &NodeProto) -> String {
    full_name(node.domain.as_deref(), node.op_type.as_deref())
}

/// Returns the name by which nodes call a function of the model, as for an operator.
pub(super) fn full_function_name(function: &FunctionProto) -> String {
    full_name(function.domain.as_deref(), function.name.as_deref())
}

fn full_name(domain: Option<&str>, kind: Option<&str>) -> String {
    let kind = kind.unwrap_or_default();
    match domain.filter(|domain| !is_standard(Some(domain))) {
        Some(domain) => format!("{domain}.{kind}"),
        None => kind.to_owned(),
    }
}

/// Returns the name of a node, or one made from its operator and its index if the node has none.
pub(super) fn node_name(node: &NodeProto, index: usize) -> String {
    let name = node.name.clone().filter(|name| !name.is_empty());
    name.unwrap_or_else(|| format!("{}_{index}", node.op_type.as_deref().unwrap_or_default()))
}

/// Returns the type of an input or an output, if the model declares one.
pub(super) fn element_type(value: &ValueInfoProto) -> Option<i32> {
    value.r#type.as_ref()?.tensor_type.as_ref()?.elem_type
}

/// Returns the name of an input or an output in the model.
pub(super) fn value_name(value: &ValueInfoProto) -> &str {
    value.name.as_deref().unwrap_or_default()
}
