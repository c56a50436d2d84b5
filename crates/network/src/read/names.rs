// SPDX-License-Identifier: MIT OR Apache-2.0
//! What nodes, operators and values are called.

use crate::onnx::{NodeProto, ValueInfoProto};

/// Whether a domain is that of the standard.
pub(super) fn is_standard(domain: Option<&str>) -> bool {
    matches!(domain, None | Some("" | "ai.onnx"))
}

/// What an operator is called, with its domain if it is not of the standard.
pub(super) fn full_kind(node: &NodeProto) -> String {
    let kind = node.op_type.as_deref().unwrap_or_default();
    match node.domain.as_deref().filter(|domain| !is_standard(Some(domain))) {
        Some(domain) => format!("{domain}.{kind}"),
        None => kind.to_owned(),
    }
}

/// What a node is called: by its name, or by its operator and its number.
pub(super) fn shown_name(node: &NodeProto, index: usize) -> String {
    let name = node.name.clone().filter(|name| !name.is_empty());
    name.unwrap_or_else(|| format!("{}_{index}", node.op_type.as_deref().unwrap_or_default()))
}

/// The type of an input or an output, if the model says it.
pub(super) fn element_type(value: &ValueInfoProto) -> Option<i32> {
    value.r#type.as_ref()?.tensor_type.as_ref()?.elem_type
}

/// What the model calls an input or an output.
pub(super) fn name_of(value: &ValueInfoProto) -> &str {
    value.name.as_deref().unwrap_or_default()
}
