// SPDX-License-Identifier: MIT OR Apache-2.0
//! The standard's description of operators by version: the numbers of inputs and outputs of a node,
//! and its attributes. `scripts/checks/onnx_schemas.py` compares the table with the schemas of ONNX
//! and onnxruntime.

use super::node;
use super::node::NodeAttributes;
use crate::onnx::{AttributeProto, NodeProto, attribute_type};
use std::collections::HashMap;
use std::sync::LazyLock;

/// A line of the table: an operator from a version on.
#[derive(Debug)]
pub(super) struct OperatorSchema {
    first_version: i64,
    inputs: (usize, Option<usize>),
    outputs: (usize, Option<usize>),
    attributes: Vec<AttributeSchema>,
}

/// An attribute that a node may have.
#[derive(Debug)]
struct AttributeSchema {
    name: &'static str,
    kind: &'static str,
    is_required: bool,
    /// The value of the attribute if the node does not have it, if that is a single number or word.
    default: Option<&'static str>,
}

/// The lines of each operator, from the oldest version to the newest.
static SCHEMAS: LazyLock<HashMap<&str, Vec<OperatorSchema>>> = LazyLock::new(|| {
    let mut schemas: HashMap<&str, Vec<OperatorSchema>> = HashMap::new();
    for line in include_str!("schemas.txt").lines() {
        let (name, schema) = parse_line(line).expect("a test reads every line of the table");
        schemas.entry(name).or_default().push(schema);
    }
    schemas
});

/// The attributes without effect on what an operator computes here, by operator.
const WITHOUT_EFFECT: &[(&str, &[&str])] = &[
    // Only training needs these attributes.
    ("BatchNormalization", &["momentum"]),
    ("Dropout", &["ratio", "seed"]),
    // Only casts to 8-bit floating-point values, which are rejected, depend on these attributes.
    ("Cast", &["round_mode", "saturate"]),
    ("CastLike", &["round_mode", "saturate"]),
    ("QuantizeLinear", &["saturate"]),
    // The attribute is the order of indices, which are an output that is rejected.
    ("MaxPool", &["storage_order"]),
    // Only the coordinates of tf_crop_and_resize, which are rejected, lie outside of the input.
    ("Resize", &["extrapolation_value"]),
    // The attribute is the precision of sums, which are always of 32 bits here.
    ("GroupNormalization", &["stash_type"]),
    ("LayerNormalization", &["stash_type"]),
    ("Range", &["stash_type"]),
];

impl OperatorSchema {
    /// Fails if a node does not conform to its operator in a version of the operators.
    pub(super) fn check(node: &NodeProto, opset: i64) -> Result<(), String> {
        let Some(schema) = Self::for_node(node, opset)? else { return Ok(()) };
        check_count("inputs", node.input.len(), schema.inputs)?;
        check_count("outputs", node.output.len(), schema.outputs)?;
        for (at, attribute) in node.attribute.iter().enumerate() {
            let name = attribute.name.as_deref().unwrap_or_default();
            let known = schema.attributes.iter().find(|known| known.name == name);
            let known = known.ok_or_else(|| schema.unknown_attribute_message(name, opset))?;
            known.check(attribute)?;
            if node.attribute[..at].iter().any(|other| other.name == attribute.name) {
                return Err(format!("it has the attribute `{name}` twice"));
            }
        }
        let has = |name: &str| node.attribute.iter().any(|own| own.name.as_deref() == Some(name));
        match schema.attributes.iter().find(|known| known.is_required && !has(known.name)) {
            Some(missing) => Err(format!("it has no attribute `{}`", missing.name)),
            None => Ok(()),
        }
    }

    /// Fails if an attribute has another value than its default, was not read and has an effect.
    pub(super) fn check_unread(attributes: &NodeAttributes<'_>, opset: i64) -> Result<(), String> {
        let node = attributes.node();
        let Some(schema) = Self::for_node(node, opset)? else { return Ok(()) };
        let operator = node::full_operator_name(node);
        let without_effect =
            WITHOUT_EFFECT.iter().find(|(kind, _)| *kind == operator).map(|&(_, names)| names);
        for attribute in attributes.unread() {
            let name = attribute.name.as_deref().unwrap_or_default();
            let default = schema.attributes.iter().find(|known| known.name == name);
            let is_default = default.is_some_and(|known| known.has_default(attribute));
            if !is_default
                && !without_effect.is_some_and(|without_effect| without_effect.contains(&name))
            {
                return Err(format!("its attribute `{name}` is not supported here"));
            }
        }
        Ok(())
    }

    /// Returns the line for a version, or `None` if the table does not have the operator.
    fn for_node(node: &NodeProto, opset: i64) -> Result<Option<&'static Self>, String> {
        let Some(lines) = SCHEMAS.get(node::full_operator_name(node).as_str()) else {
            return Ok(None);
        };
        // Operators of other domains have a separate version, which is 1.
        let version = if node::is_standard(node.domain.as_deref()) { opset } else { 1 };
        match lines.iter().rev().find(|schema| schema.first_version <= version) {
            Some(schema) => Ok(Some(schema)),
            None => Err(format!(
                "it exists since version {} of the operators, but the model uses version {opset}",
                lines[0].first_version
            )),
        }
    }

    fn unknown_attribute_message(&self, name: &str, opset: i64) -> String {
        let known: Vec<_> = self.attributes.iter().map(|known| known.name).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        format!("it has no attribute `{name}` in version {opset} of the operators; it has {known}")
    }
}

impl AttributeSchema {
    /// Fails if the value of an attribute has another type.
    fn check(&self, attribute: &AttributeProto) -> Result<(), String> {
        if attribute.ref_attr_name.as_deref().is_some_and(|name| !name.is_empty()) {
            return Err(format!(
                "its attribute `{}` refers to an attribute of a function, which is not supported",
                self.name
            ));
        }
        // Models of the first version of the format do not declare the types of attributes.
        let kind = match attribute.r#type.unwrap_or(0) {
            0 => inferred_type(attribute),
            kind => attribute_type::type_name(kind),
        };
        if kind.is_none_or(|kind| kind != self.kind) {
            let kind = kind.unwrap_or("another type");
            return Err(format!(
                "its attribute `{}` is of {kind}, not of {}",
                self.name, self.kind
            ));
        }
        Ok(())
    }

    fn has_default(&self, attribute: &AttributeProto) -> bool {
        match (self.kind, self.default) {
            ("INT", Some(default)) => default.parse() == Ok(attribute.i.unwrap_or(0)),
            ("FLOAT", Some(default)) => default.parse() == Ok(attribute.f.unwrap_or(0.0)),
            ("STRING", Some(default)) => attribute.s.as_deref() == Some(default.as_bytes()),
            _ => false,
        }
    }
}

/// Infers the type of an attribute that does not declare it.
fn inferred_type(attribute: &AttributeProto) -> Option<&'static str> {
    let AttributeProto { f, i, s, t, floats, ints, .. } = attribute;
    match () {
        () if f.is_some() => Some("FLOAT"),
        () if i.is_some() => Some("INT"),
        () if s.is_some() => Some("STRING"),
        () if t.is_some() => Some("TENSOR"),
        () if !floats.is_empty() => Some("FLOATS"),
        () if !ints.is_empty() => Some("INTS"),
        () => None,
    }
}

/// Fails if a count is not in its range.
fn check_count(
    what: &str,
    count: usize,
    (least, most): (usize, Option<usize>),
) -> Result<(), String> {
    if count >= least && most.is_none_or(|most| count <= most) {
        return Ok(());
    }
    let allowed = match most {
        Some(most) if most == least => format!("{least}"),
        Some(most) => format!("{least} to {most}"),
        None => format!("at least {least}"),
    };
    Err(format!("it has {count} {what}; its operator has {allowed}"))
}

/// Parses a line of the table, and returns the name of its operator with it.
fn parse_line(line: &'static str) -> Option<(&'static str, OperatorSchema)> {
    let mut words = line.split(' ');
    let name = words.next()?;
    let first_version = words.next()?.parse().ok()?;
    let (inputs, outputs) = (parse_range(words.next()?)?, parse_range(words.next()?)?);
    let attributes = words.map(parse_attribute).collect::<Option<_>>()?;
    Some((name, OperatorSchema { first_version, inputs, outputs, attributes }))
}

fn parse_range(word: &str) -> Option<(usize, Option<usize>)> {
    let (least, most) = word.split_once("..")?;
    let most = if most.is_empty() { None } else { Some(most.parse().ok()?) };
    Some((least.parse().ok()?, most))
}

fn parse_attribute(word: &'static str) -> Option<AttributeSchema> {
    let (name, rest) = word.split_once(':')?;
    let (rest, default) = match rest.split_once('=') {
        Some((kind, default)) => (kind, Some(default)),
        None => (rest, None),
    };
    let kind = rest.trim_end_matches('!');
    Some(AttributeSchema { name, kind, is_required: kind != rest, default })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reader::operators;

    #[test]
    fn every_supported_operator_has_lines_and_no_other() {
        let mut own: Vec<&str> = SCHEMAS.keys().copied().collect();
        own.sort_unstable();
        assert_eq!(own, operators().collect::<Vec<_>>());
    }

    #[test]
    fn attributes_without_effect_are_attributes() {
        for (kind, names) in WITHOUT_EFFECT {
            for name in *names {
                let has =
                    |schema: &OperatorSchema| schema.attributes.iter().any(|own| own.name == *name);
                assert!(SCHEMAS[kind].iter().any(has), "{kind} has no {name}");
            }
        }
    }
}
