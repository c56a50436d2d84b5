// SPDX-License-Identifier: MIT OR Apache-2.0
//! A node as the readers of operators see it ([`NodeReader`]): attributes with their defaults,
//! constants, and tensors go in, and outputs come out ([`NodeOutput`]). [`NodeAttributes`]
//! records which attributes were read, because one that no reader asks for may change what the
//! node computes. Nodes, operators, inputs and outputs have names for messages ([`node_name`]).

use super::constant::Constant;
use super::model_folder::ModelFolder;
use crate::activation::Activation;
use crate::element::{ElementType, with_byte_type};
use crate::mask::AxisWindow;
use crate::onnx::{AttributeProto, FunctionProto, NodeProto, ValueInfoProto, data_type};
use crate::operator::{ConvGeometry, Operator};
use crate::tensor::{Tensor, TensorForm};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// The meaning of a name in the graph.
#[derive(Clone, Debug)]
pub(super) enum GraphValue {
    /// A tensor of the network.
    Tensor(usize),
    Constant(Arc<Constant>),
}

/// An operand of an operator: a tensor of the network, or a constant.
pub(super) enum Operand {
    Tensor(usize),
    Constant(Tensor),
}

pub(super) struct NodeReader<'a> {
    pub(super) node: &'a NodeProto,
    pub(super) attributes: &'a NodeAttributes<'a>,
    pub(super) values: &'a HashMap<String, GraphValue>,
    pub(super) folder: &'a ModelFolder,
    /// The version of the operators.
    pub(super) opset: i64,
    pub(super) forms: &'a dyn Fn(usize) -> TensorForm,
}

impl<'a> NodeReader<'a> {
    pub(super) fn operator_name(&self) -> &str {
        self.node.op_type.as_deref().unwrap_or_default()
    }

    /// Returns the name of the operator with the domain, if that is not the standard one.
    pub(super) fn full_operator_name(&self) -> String {
        full_operator_name(self.node)
    }

    fn attribute(&self, name: &str) -> Option<&AttributeProto> {
        self.attributes.get(name)
    }

    pub(super) fn has_attribute(&self, name: &str) -> bool {
        self.attribute(name).is_some()
    }

    pub(super) fn int(&self, name: &str, default: i64) -> i64 {
        // A writer may leave out a field whose value is 0.
        self.attribute(name).map_or(default, |attribute| attribute.i.unwrap_or(0))
    }

    /// Returns the type that an attribute gives by its number in `data_type`.
    pub(super) fn data_type(&self, name: &str) -> Result<i32, String> {
        let kind = self.int(name, 0);
        i32::try_from(kind).map_err(|_| format!("its {name} is {}", data_type::type_name(kind)))
    }

    pub(super) fn float(&self, name: &str, default: f32) -> f32 {
        self.attribute(name).map_or(default, |attribute| attribute.f.unwrap_or(0.0))
    }

    pub(super) fn text(&self, name: &str, default: &'static str) -> String {
        match self.attribute(name).map(|attribute| attribute.s.as_deref().unwrap_or_default()) {
            Some(text) => String::from_utf8_lossy(text).into_owned(),
            None => default.to_owned(),
        }
    }

    pub(super) fn ints(&self, name: &str) -> Option<&[i64]> {
        self.attribute(name).map(|attribute| attribute.ints.as_slice())
    }

    pub(super) fn floats(&self, name: &str) -> Option<&[f32]> {
        self.attribute(name).map(|attribute| attribute.floats.as_slice())
    }

    /// Returns the constant tensor of an attribute.
    pub(super) fn tensor(&self, name: &str) -> Result<Option<Constant>, String> {
        let tensor = self.attribute(name).and_then(|attribute| attribute.t.as_ref());
        tensor.map(|tensor| Constant::decode(tensor, self.folder)).transpose()
    }

    pub(super) fn input(&self, at: usize) -> Option<&'a GraphValue> {
        self.node
            .input
            .get(at)
            .filter(|name| !name.is_empty())
            .and_then(|name| self.values.get(name))
    }

    /// Returns an input, which must be a constant if the node has it.
    pub(super) fn constant(&self, at: usize, what: &str) -> Result<Option<&'a Constant>, String> {
        match self.input(at) {
            None => Ok(None),
            Some(GraphValue::Constant(constant)) => Ok(Some(constant)),
            Some(GraphValue::Tensor(_)) => Err(format!("its {what} must be constant")),
        }
    }

    /// Returns an input, which must be one constant integer of 8 bits if the node has it.
    pub(super) fn byte_constant(
        &self,
        at: usize,
        what: &str,
        element: ElementType,
    ) -> Result<Option<i32>, String> {
        let Some(constant) = self.constant(at, what)? else { return Ok(None) };
        let tensor =
            constant.single_value(element).map_err(|problem| format!("its {what}: {problem}"))?;
        Ok(Some(with_byte_type!(element, T => tensor.values::<T>()[0].into())))
    }

    /// Returns an input, which the node must have and which must be a constant.
    pub(super) fn required_constant(&self, at: usize, what: &str) -> Result<&'a Constant, String> {
        self.constant(at, what)?.ok_or_else(|| format!("it has no {what}"))
    }

    /// Returns an input as an operand: a tensor of the network, or a constant.
    pub(super) fn operand(&self, at: usize) -> Result<Operand, String> {
        match self.input(at) {
            Some(&GraphValue::Tensor(value)) => Ok(Operand::Tensor(value)),
            Some(GraphValue::Constant(constant)) => Ok(Operand::Constant(constant.tensor()?)),
            None => Err(format!("it has no input {at}")),
        }
    }

    /// Returns an input, which must be a tensor of the network.
    pub(super) fn tensor_input(&self, at: usize) -> Result<usize, String> {
        match self.input(at) {
            Some(&GraphValue::Tensor(value)) => Ok(value),
            Some(GraphValue::Constant(_)) => Err(format!("its input {at} must not be constant")),
            None => Err(format!("it has no input {at}")),
        }
    }

    /// Returns integers from an attribute or, in later versions of the operator, from an input.
    pub(super) fn ints_or_input(
        &self,
        attribute: &str,
        input: usize,
    ) -> Result<Option<Vec<i64>>, String> {
        if let Some(ints) = self.ints(attribute) {
            return Ok(Some(ints.to_vec()));
        }
        let constant = self.constant(input, attribute)?;
        constant.map(|constant| constant.as_integers().map(<[i64]>::to_vec)).transpose()
    }

    /// Returns the windows, along rows and columns, of a convolution or of pooling with this
    /// kernel; `value` is the tensor of the input.
    pub(super) fn axis_windows(
        &self,
        kernel: [usize; 2],
        value: usize,
    ) -> Result<[AxisWindow; 2], String> {
        let pair = |name: &str| -> Result<[usize; 2], String> {
            match self.ints(name) {
                None => Ok([1, 1]),
                Some(&[rows, columns]) => {
                    Ok([checked_length(name, rows)?, checked_length(name, columns)?])
                }
                Some(ints) => Err(format!("its {name} has {} values, not 2", ints.len())),
            }
        };
        let (stride, dilation) = (pair("strides")?, pair("dilations")?);
        let form = (self.forms)(value);
        let &[_, _, height, width] = form.shape() else {
            return Err(format!(
                "its input must be features [1, channels, height, width], not {}",
                form.describe()
            ));
        };
        let sizes = [height, width];
        let pads = match (self.text("auto_pad", "NOTSET").as_str(), self.ints("pads")) {
            ("VALID", _) | ("NOTSET", None) => [[0; 2]; 2],
            ("NOTSET", Some(&[top, left, bottom, right])) => {
                let pad = |pad: i64| {
                    usize::try_from(pad)
                        .ok()
                        .filter(|&pad| pad < 1 << 16)
                        .ok_or_else(|| format!("its pads are {pad}; they must be 0 to 65535"))
                };
                [[pad(top)?, pad(bottom)?], [pad(left)?, pad(right)?]]
            }
            ("NOTSET", Some(pads)) => {
                return Err(format!("its pads have {} values, not 4", pads.len()));
            }
            (mode @ ("SAME_UPPER" | "SAME_LOWER"), _) => {
                // The number of outputs is the length of the input by the stride, rounded up. The
                // padding is the part of the last window that lies beyond the input. An odd element
                // goes to the end for SAME_UPPER, and to the front for SAME_LOWER.
                let along = |axis: usize| {
                    let span = (kernel[axis] - 1) * dilation[axis] + 1;
                    let outputs = sizes[axis].div_ceil(stride[axis]);
                    let all = ((outputs - 1) * stride[axis] + span).saturating_sub(sizes[axis]);
                    if mode == "SAME_UPPER" {
                        [all / 2, all.div_ceil(2)]
                    } else {
                        [all.div_ceil(2), all / 2]
                    }
                };
                [along(0), along(1)]
            }
            (mode, _) => return Err(format!("its auto_pad is `{mode}`")),
        };
        let window = |axis: usize| AxisWindow {
            kernel: kernel[axis],
            stride: stride[axis],
            dilation: dilation[axis],
            padding_before: pads[axis][0],
            padding_after: pads[axis][1],
        };
        Ok([window(0), window(1)])
    }

    /// Returns the geometry of a convolution of `value` with weights of this shape.
    pub(super) fn conv_geometry(
        &self,
        weights: &[usize],
        value: usize,
    ) -> Result<ConvGeometry, String> {
        let &[_, _, height, width] = weights else {
            return Err(format!(
                "its weights have {} axes; only two-dimensional convolution is supported",
                weights.len()
            ));
        };
        let kernel = self.kernel_shape()?.unwrap_or([height, width]);
        if kernel != [height, width] || height == 0 || width == 0 {
            return Err(format!(
                "its kernel_shape is {kernel:?}, but its weights are {height}x{width}"
            ));
        }
        let groups = checked_length("group", self.int("group", 1))?;
        ConvGeometry::new(weights, self.axis_windows(kernel, value)?, groups)
    }

    /// Returns the attribute `kernel_shape`.
    pub(super) fn kernel_shape(&self) -> Result<Option<[usize; 2]>, String> {
        match self.ints("kernel_shape") {
            None => Ok(None),
            Some(&[rows, columns]) => Ok(Some([
                checked_length("kernel_shape", rows)?,
                checked_length("kernel_shape", columns)?,
            ])),
            Some(ints) => Err(format!("its kernel_shape has {} values, not 2", ints.len())),
        }
    }
}

/// Checks that a length is from 1 to 65535.
pub(super) fn checked_length(what: &str, value: i64) -> Result<usize, String> {
    usize::try_from(value)
        .ok()
        .filter(|&value| (1..1 << 16).contains(&value))
        .ok_or_else(|| format!("its {what} is {value}; it must be 1 to 65535"))
}

/// Converts a length to the integer type of ONNX.
pub(super) fn length_to_i64(length: usize) -> i64 {
    i64::try_from(length).expect("a length is below 2^63")
}

/// Converts an index to one that counts from the start. A negative index counts from the end.
pub(super) fn index_from_start(at: i64, length: usize) -> i64 {
    if at < 0 { at.saturating_add(length_to_i64(length)) } else { at }
}

pub(super) enum NodeOutput {
    Constant(Constant),
    /// The output is an input of the node.
    Alias(GraphValue),
    Operator(Arc<dyn Operator>, Vec<Operand>),
    /// The output is an activation of a tensor. The operator that makes the tensor may apply it.
    Activated(Activation, usize),
}

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

/// The attributes of a node. An attribute that no reader asks for may change what the node
/// computes, so each access is recorded.
pub(super) struct NodeAttributes<'a> {
    node: &'a NodeProto,
    /// True for each attribute that was read, in the order of the node.
    was_read: RefCell<Vec<bool>>,
}

impl<'a> NodeAttributes<'a> {
    pub(super) fn new(node: &'a NodeProto) -> Self {
        Self { node, was_read: RefCell::new(vec![false; node.attribute.len()]) }
    }

    pub(super) fn node(&self) -> &'a NodeProto {
        self.node
    }

    /// Returns an attribute by its name, and records it as read.
    pub(super) fn get(&self, name: &str) -> Option<&'a AttributeProto> {
        let at = self
            .node
            .attribute
            .iter()
            .position(|attribute| attribute.name.as_deref() == Some(name))?;
        self.was_read.borrow_mut()[at] = true;
        Some(&self.node.attribute[at])
    }

    pub(super) fn unread(&self) -> impl Iterator<Item = &'a AttributeProto> {
        let read = self.was_read.borrow().clone();
        self.node
            .attribute
            .iter()
            .zip(read)
            .filter(|(_, read)| !read)
            .map(|(attribute, _)| attribute)
    }
}

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
