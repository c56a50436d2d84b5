// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that act on each value separately: activations, arithmetic and scaling.

use super::constant::Constant;
use super::constant_arithmetic;
use super::node::{GraphValue, NodeOutput, NodeReader, output_of_operands, output_of_tensors};
use crate::activation::Activation;
use crate::element::ElementType;
use crate::onnx::data_type;
use crate::operator::{
    ActivationOperator, ArithmeticKind, BinaryOperator, ByteTable, ChannelScale, ComparisonKind,
    ComparisonOperator, Dequantize, Operator, QuantizationScales, WhereOperator,
};
use crate::tensor::{Tensor, TensorForm};
use std::sync::Arc;

/// Returns an activation as a separate operator.
pub(super) fn activation_operator(activation: Activation) -> Arc<dyn Operator> {
    Arc::new(ActivationOperator(activation))
}

pub(super) fn activation(
    node: &NodeReader<'_>,
    activation: Activation,
) -> Result<Vec<NodeOutput>, String> {
    Ok(vec![NodeOutput::Activated(activation, node.tensor_input(0)?)])
}

pub(super) fn relu(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    // ONNX defines `Relu` for signed integers, too.
    match (node.forms)(value).encoding().element {
        ElementType::I8 => output_of_tensors(
            ByteTable::from_stored_function(ElementType::I8, |stored| stored.max(0)),
            vec![value],
        ),
        _ => activation(node, Activation::Relu),
    }
}

pub(super) fn identity(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    Ok(vec![NodeOutput::Alias(node.input(0).ok_or("it has no input")?.clone())])
}

pub(super) fn dropout(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let training = node.constant(2, "training_mode")?;
    if training
        .is_some_and(|training| training.as_integers().is_ok_and(|values| values.contains(&1)))
    {
        return Err("it is in training mode".to_owned());
    }
    identity(node)
}

pub(super) fn cast(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    cast_to(node, node.data_type("to")?)
}

/// Reads a cast to the type of the second input, which has no other meaning.
pub(super) fn cast_like(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let kind = match node.input(1).ok_or("it has no second input")? {
        GraphValue::Constant(like) => like.data_type,
        &GraphValue::Tensor(like) => match (node.forms)(like).encoding().element {
            ElementType::F32 => data_type::FLOAT,
            ElementType::I8 => data_type::INT8,
            ElementType::I32 => data_type::INT32,
            ElementType::U8 => {
                return Err("a cast to the type of a tensor of UINT8 or BOOL that is not constant is not supported".to_owned());
            }
        },
    };
    match node.input(0) {
        Some(GraphValue::Constant(constant)) => {
            Ok(vec![NodeOutput::Constant(constant.cast(kind)?)])
        }
        _ => cast_to(node, kind),
    }
}

/// Reads a cast of a tensor that is not constant. Values of 16 and 64 bits are kept as 32-bit
/// values.
fn cast_to(node: &NodeReader<'_>, kind: i32) -> Result<Vec<NodeOutput>, String> {
    use data_type::{BFLOAT16, DOUBLE, FLOAT, FLOAT16};
    let element = |value: usize| (node.forms)(value).encoding().element;
    match kind {
        FLOAT | FLOAT16 | BFLOAT16 | DOUBLE => match node.input(0) {
            Some(&GraphValue::Tensor(value)) if element(value) != ElementType::F32 => {
                output_of_tensors(Dequantize(QuantizationScales::per_tensor(1.0, 0)), vec![value])
            }
            _ => identity(node),
        },
        other => Err(format!(
            "a cast of a tensor that is not constant to {} is not supported, only one to FLOAT, FLOAT16, BFLOAT16 or DOUBLE",
            data_type::type_name(other.into())
        )),
    }
}

/// Reads a power, whose exponent may be of integers.
pub(super) fn power(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    match (node.tensor_input(0), node.input(1)) {
        (Ok(value), Some(GraphValue::Constant(exponent)))
            if (node.forms)(value).encoding().element == ElementType::F32 =>
        {
            let exponent = constant_arithmetic::cast_exponent(exponent, data_type::FLOAT)?;
            let weights = exponent.as_weights()?.to_vec();
            let exponent =
                Tensor::new(TensorForm::without_positions(exponent.shape.clone()), weights);
            let constant = Some((exponent, false));
            output_of_tensors(
                BinaryOperator {
                    kind: ArithmeticKind::Pow,
                    constant,
                    activation: Activation::Identity,
                },
                vec![value],
            )
        }
        _ => binary(node, ArithmeticKind::Pow),
    }
}

pub(super) fn binary(
    node: &NodeReader<'_>,
    kind: ArithmeticKind,
) -> Result<Vec<NodeOutput>, String> {
    let tensor = |constant: &Constant| -> Result<Tensor, String> {
        Ok(Tensor::new(
            TensorForm::without_positions(constant.shape.clone()),
            constant.as_weights()?.to_vec(),
        ))
    };
    match (node.input(0), node.input(1), node.input(2)) {
        (Some(&GraphValue::Tensor(a)), Some(&GraphValue::Tensor(b)), None) => output_of_tensors(
            BinaryOperator { kind, constant: None, activation: Activation::Identity },
            vec![a, b],
        ),
        (Some(GraphValue::Constant(a)), Some(&GraphValue::Tensor(b)), None) => output_of_tensors(
            BinaryOperator {
                kind,
                constant: Some((tensor(a)?, true)),
                activation: Activation::Identity,
            },
            vec![b],
        ),
        (Some(&GraphValue::Tensor(a)), Some(GraphValue::Constant(b)), None) => output_of_tensors(
            BinaryOperator {
                kind,
                constant: Some((tensor(b)?, false)),
                activation: Activation::Identity,
            },
            vec![a],
        ),
        _ => Err(format!(
            "it has {} inputs; only two are supported, of which at most one is constant",
            node.node.input.len()
        )),
    }
}

pub(super) fn compare(
    node: &NodeReader<'_>,
    comparison: ComparisonKind,
) -> Result<Vec<NodeOutput>, String> {
    output_of_operands(ComparisonOperator(comparison), vec![node.operand(0)?, node.operand(1)?])
}

pub(super) fn select(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    output_of_operands(WhereOperator, vec![node.operand(0)?, node.operand(1)?, node.operand(2)?])
}

pub(super) fn sum(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    if node.input(1).is_none() { identity(node) } else { binary(node, ArithmeticKind::Add) }
}

pub(super) fn gelu(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    match node.text("approximate", "none").as_str() {
        "none" => activation(node, Activation::Gelu),
        "tanh" => activation(node, Activation::TanhGelu),
        other => Err(format!("approximate = {other} is unknown; it must be none or tanh")),
    }
}

pub(super) fn clip(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let element = (node.forms)(value).encoding().element;
    if element.is_byte() {
        let (min, max) =
            (node.byte_constant(1, "min", element)?, node.byte_constant(2, "max", element)?);
        let within = |stored: i32| {
            let stored = min.map_or(stored, |min| stored.max(min));
            max.map_or(stored, |max| stored.min(max))
        };
        return output_of_tensors(ByteTable::from_stored_function(element, within), vec![value]);
    }
    let bound = |attribute: &str, input: usize, default: f32| -> Result<f32, String> {
        match node.constant(input, attribute)? {
            Some(constant) => constant
                .as_floats()?
                .first()
                .copied()
                .ok_or_else(|| format!("its {attribute} is empty")),
            None => Ok(node.float(attribute, default)),
        }
    };
    let (min, max) = (bound("min", 1, f32::NEG_INFINITY)?, bound("max", 2, f32::INFINITY)?);
    activation(node, Activation::Clip { min, max })
}

pub(super) fn batch_normalization(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    if node.int("training_mode", 0) != 0 {
        return Err("it is in training mode".to_owned());
    }
    if node.int("spatial", 1) != 1 {
        return Err("spatial = 0, a normalization of each place, is not supported".to_owned());
    }
    let at = |at, what| node.required_constant(at, what).and_then(Constant::as_weights);
    let epsilon = node.float("epsilon", 1e-5);
    let scale = ChannelScale::from_batch_normalization(
        at(1, "scale")?,
        at(2, "bias")?,
        at(3, "mean")?,
        at(4, "variance")?,
        epsilon,
    )?;
    output_of_tensors(scale, vec![node.tensor_input(0)?])
}
