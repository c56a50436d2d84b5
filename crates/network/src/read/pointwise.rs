// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that act on each value separately: activations, arithmetic and scaling.

use super::constant::Constant;
use super::elementwise;
use super::made::{Made, of, one};
use super::node::{Known, NodeReader};
use crate::element::Element;
use crate::form::Form;
use crate::onnx::data_type;
use crate::operator::{
    Activation, Arithmetic, Binary, Compare, Comparison, Dequantize, Operator, Pointwise, Scale,
    Scales, Select, Table,
};
use crate::tensor::Tensor;
use std::sync::Arc;

/// Returns an activation as a separate operator.
pub(super) fn pointwise(activation: Activation) -> Arc<dyn Operator> {
    Arc::new(Pointwise(activation))
}

pub(super) fn finish(node: &NodeReader<'_>, activation: Activation) -> Result<Vec<Made>, String> {
    Ok(vec![Made::Finish(activation, node.value(0)?)])
}

pub(super) fn relu(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    // ONNX defines `Relu` for signed integers, too.
    match (node.forms)(value).encoding().element {
        Element::I8 => one(Table::of_stored(Element::I8, |stored| stored.max(0)), vec![value]),
        _ => finish(node, Activation::Relu),
    }
}

pub(super) fn same(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    Ok(vec![Made::Same(node.input(0).ok_or("it has no input")?.clone())])
}

pub(super) fn dropout(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let training = node.constant(2, "training_mode")?;
    if training
        .is_some_and(|training| training.as_integers().is_ok_and(|values| values.contains(&1)))
    {
        return Err("it is in training mode".to_owned());
    }
    same(node)
}

pub(super) fn cast(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    cast_to(node, node.kind_of("to")?)
}

/// Reads a cast to the type of the second input, which has no other meaning.
pub(super) fn cast_like(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let kind = match node.input(1).ok_or("it has no second input")? {
        Known::Constant(like) => like.kind,
        &Known::Value(like) => match (node.forms)(like).encoding().element {
            Element::F32 => data_type::FLOAT,
            Element::I8 => data_type::INT8,
            Element::I32 => data_type::INT32,
            Element::U8 => {
                return Err("a cast to the type of a tensor of UINT8 or BOOL that is not constant is not supported".to_owned());
            }
        },
    };
    match node.input(0) {
        Some(Known::Constant(constant)) => Ok(vec![Made::Constant(constant.cast(kind)?)]),
        _ => cast_to(node, kind),
    }
}

/// Reads a cast of a tensor that is not constant. Values of 16 and 64 bits are kept as 32-bit
/// values.
fn cast_to(node: &NodeReader<'_>, kind: i32) -> Result<Vec<Made>, String> {
    use data_type::{BFLOAT16, DOUBLE, FLOAT, FLOAT16};
    let element = |value: usize| (node.forms)(value).encoding().element;
    match kind {
        FLOAT | FLOAT16 | BFLOAT16 | DOUBLE => match node.input(0) {
            Some(&Known::Value(value)) if element(value) != Element::F32 => {
                one(Dequantize(Scales::one(1.0, 0)), vec![value])
            }
            _ => same(node),
        },
        other => Err(format!(
            "a cast of a tensor that is not constant to {} is not supported, only one to FLOAT, FLOAT16, BFLOAT16 or DOUBLE",
            data_type::name(other.into())
        )),
    }
}

/// Reads a power, whose exponent may be of integers.
pub(super) fn power(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    match (node.value(0), node.input(1)) {
        (Ok(value), Some(Known::Constant(exponent)))
            if (node.forms)(value).encoding().element == Element::F32 =>
        {
            let exponent = elementwise::exponent(exponent, data_type::FLOAT)?;
            let weights = exponent.as_weights()?.to_vec();
            let exponent = Tensor::new(Form::whole(exponent.shape.clone()), weights);
            let constant = Some((exponent, false));
            one(
                Binary { kind: Arithmetic::Pow, constant, finish: Activation::Identity },
                vec![value],
            )
        }
        _ => binary(node, Arithmetic::Pow),
    }
}

pub(super) fn binary(node: &NodeReader<'_>, kind: Arithmetic) -> Result<Vec<Made>, String> {
    let tensor = |constant: &Constant| -> Result<Tensor, String> {
        Ok(Tensor::new(Form::whole(constant.shape.clone()), constant.as_weights()?.to_vec()))
    };
    match (node.input(0), node.input(1), node.input(2)) {
        (Some(&Known::Value(a)), Some(&Known::Value(b)), None) => {
            one(Binary { kind, constant: None, finish: Activation::Identity }, vec![a, b])
        }
        (Some(Known::Constant(a)), Some(&Known::Value(b)), None) => one(
            Binary { kind, constant: Some((tensor(a)?, true)), finish: Activation::Identity },
            vec![b],
        ),
        (Some(&Known::Value(a)), Some(Known::Constant(b)), None) => one(
            Binary { kind, constant: Some((tensor(b)?, false)), finish: Activation::Identity },
            vec![a],
        ),
        _ => Err(format!(
            "it has {} inputs; only two are supported, not both constant",
            node.node.input.len()
        )),
    }
}

pub(super) fn compare(node: &NodeReader<'_>, comparison: Comparison) -> Result<Vec<Made>, String> {
    of(Compare(comparison), vec![node.operand(0)?, node.operand(1)?])
}

pub(super) fn select(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    of(Select, vec![node.operand(0)?, node.operand(1)?, node.operand(2)?])
}

pub(super) fn sum(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    if node.input(1).is_none() { same(node) } else { binary(node, Arithmetic::Add) }
}

pub(super) fn gelu(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    match node.text("approximate", "none").as_str() {
        "none" => finish(node, Activation::Gelu),
        "tanh" => finish(node, Activation::TanhGelu),
        other => Err(format!("approximate = {other} is unknown; it is none or tanh")),
    }
}

pub(super) fn clip(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let value = node.value(0)?;
    let element = (node.forms)(value).encoding().element;
    if element.is_byte() {
        let (min, max) = (node.stored(1, "min", element)?, node.stored(2, "max", element)?);
        let within = |stored: i32| {
            let stored = min.map_or(stored, |min| stored.max(min));
            max.map_or(stored, |max| stored.min(max))
        };
        return one(Table::of_stored(element, within), vec![value]);
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
    finish(node, Activation::Clip { min, max })
}

pub(super) fn normalization(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    if node.int("training_mode", 0) != 0 {
        return Err("it is in training mode".to_owned());
    }
    if node.int("spatial", 1) != 1 {
        return Err("spatial = 0, a normalization of each place, is not supported".to_owned());
    }
    let at = |at, what| node.wanted(at, what).and_then(Constant::as_weights);
    let epsilon = node.float("epsilon", 1e-5);
    let scale = Scale::normalization(
        at(1, "scale")?,
        at(2, "bias")?,
        at(3, "mean")?,
        at(4, "variance")?,
        epsilon,
    )?;
    one(scale, vec![node.value(0)?])
}
