// SPDX-License-Identifier: MIT OR Apache-2.0
//! The input of a network, and its form for the frames or arrays that it takes.

use super::constant::Constant;
use super::model_folder::ModelFolder;
use super::node::{GraphValue, full_operator_name, is_standard, node_name, value_name};
use crate::element::ElementType;
use crate::error::NetworkError;
use crate::onnx::{GraphProto, NodeProto, TensorProto, ValueInfoProto, data_type};
use crate::tensor::{InputLayout, TensorForm};
use std::sync::Arc;

/// The width and height of the frames, for a network that takes frames of any size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSize {
    /// The pixels of a row.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
}

/// The permutation that puts the channels first.
const CHANNELS_FIRST: [i64; 4] = [0, 3, 1, 2];

/// Returns true if a node does nothing but put the channels of `value` first.
pub(super) fn puts_channels_first(node: &NodeProto, value: &str) -> bool {
    let order = node.attribute.iter().find(|attribute| attribute.name.as_deref() == Some("perm"));
    is_standard(node.domain.as_deref())
        && node.op_type.as_deref() == Some("Transpose")
        && node.input == [value]
        && node.output.len() == 1
        && order.is_some_and(|order| order.ints == CHANNELS_FIRST)
}

/// Returns the layout of the input, derived from its shape and from the nodes that take it.
fn input_layout(
    input: &ValueInfoProto,
    lengths: &[Option<usize>],
    graph: &GraphProto,
) -> Result<InputLayout, NetworkError> {
    let is_colours = |length: Option<usize>| matches!(length, Some(1 | 3));
    let &[_, second, _, last] = lengths else { return Ok(InputLayout::Nchw) };
    if is_colours(second) || !is_colours(last) {
        return Ok(InputLayout::Nchw);
    }
    let name = value_name(input);
    let is_taken_by = |node: &NodeProto| node.input.iter().any(|other| other == name);
    let mut obstacle = graph.node.iter().enumerate();
    let obstacle = obstacle.find(|(_, node)| is_taken_by(node) && !puts_channels_first(node, name));
    let obstacle = obstacle.map(|(index, node)| {
        format!(
            "node `{}` ({}) takes it in this order",
            node_name(node, index),
            full_operator_name(node)
        )
    });
    let is_output = graph.output.iter().any(|output| value_name(output) == name);
    match obstacle.or_else(|| is_output.then(|| "it is an output, too".to_owned())) {
        None => Ok(InputLayout::Nhwc),
        Some(obstacle) => Err(NetworkError::InvalidNetwork(format!(
            "its input `{name}` is [1, height, width, channels], and {obstacle}; only a Transpose of perm {CHANNELS_FIRST:?} may take such an input. Export it with channels first, as tf2onnx does with --inputs-as-nchw {name}"
        ))),
    }
}

/// The inputs of a network as they are bound when it is read.
pub(super) struct InputBinding {
    /// The form of the input with the channels first.
    pub(super) form: TensorForm,
    pub(super) layout: InputLayout,
    /// The names of the inputs, each with its tensor or constant.
    pub(super) values: Vec<(String, GraphValue)>,
    /// The name of the input and its stored type, if it is stored in 8 bits.
    pub(super) stored_input: Option<(String, ElementType)>,
    /// The values of the input, if an array provides them.
    pub(super) input_values: Vec<f32>,
}

/// Binds the only input, which takes frames.
pub(super) fn frame_input(
    inputs: &[&ValueInfoProto],
    graph: &GraphProto,
    frames: Option<FrameSize>,
    open: Option<FrameSize>,
) -> Result<InputBinding, NetworkError> {
    let &[input] = inputs else {
        let names: Vec<_> = inputs.iter().map(|input| value_name(input)).collect();
        return Err(NetworkError::InvalidNetwork(format!(
            "it must have one input, the frame, but it has {} ({})",
            inputs.len(),
            names.join(", ")
        )));
    };
    let (form, layout) = input_form(input, graph, frames, open)?;
    let known = vec![(value_name(input).to_owned(), GraphValue::Tensor(0))];
    Ok(InputBinding { form, layout, values: known, stored_input: None, input_values: Vec::new() })
}

/// Binds one array to each input. The first array that the executor can take becomes the input of
/// the network, and the others become constants.
pub(super) fn array_inputs(
    inputs: &[&ValueInfoProto],
    arrays: &[TensorProto],
    folder: &ModelFolder,
) -> Result<InputBinding, NetworkError> {
    if inputs.len() != arrays.len() {
        let names: Vec<_> = inputs.iter().map(|input| value_name(input)).collect();
        return Err(NetworkError::InvalidNetwork(format!(
            "it has {} inputs ({}), but {} arrays are given; give one for each, in this order",
            inputs.len(),
            names.join(", "),
            arrays.len()
        )));
    }
    let mut binding = InputBinding {
        form: TensorForm::without_positions(vec![1]),
        layout: InputLayout::Nchw,
        values: Vec::new(),
        stored_input: None,
        input_values: vec![0.0],
    };
    let mut is_taken = false;
    for (input, array) in inputs.iter().zip(arrays) {
        let name = value_name(input).to_owned();
        check_array(input, array)?;
        let wrong = |problem| {
            NetworkError::InvalidNetwork(format!("its input `{}`: {problem}", value_name(input)))
        };
        let constant = Constant::decode(array, folder).map_err(wrong)?;
        let is_float = matches!(constant.element(), Some(ElementType::F32));
        let is_byte = [data_type::UINT8, data_type::INT8].contains(&constant.data_type);
        if is_taken || !(is_float || is_byte) || constant.values.value_count() == 0 {
            binding.values.push((name, GraphValue::Constant(Arc::new(constant))));
            continue;
        }
        is_taken = true;
        binding.form = TensorForm::features(constant.shape.clone());
        binding.values.push((name.clone(), GraphValue::Tensor(0)));
        binding.stored_input =
            constant.element().filter(|_| is_byte).map(|element| (name, element));
        let floats = constant.cast(data_type::FLOAT).map_err(wrong)?;
        binding.input_values = floats.as_floats().map_err(wrong)?.to_vec();
    }
    Ok(binding)
}

/// Fails if an array has another type or shape than its input.
fn check_array(input: &ValueInfoProto, array: &TensorProto) -> Result<(), NetworkError> {
    let name = value_name(input);
    let tensor = input.r#type.as_ref().and_then(|value_type| value_type.tensor_type.as_ref());
    let tensor = tensor.ok_or_else(|| {
        NetworkError::InvalidNetwork(format!(
            "its input `{name}` is not a tensor, and other types are not supported"
        ))
    })?;
    let type_text = |kind: Option<i32>| data_type::type_name(kind.unwrap_or(0).into());
    if tensor.elem_type != array.data_type {
        return Err(NetworkError::InvalidNetwork(format!(
            "its input `{name}` takes {}, but the array holds {}",
            type_text(tensor.elem_type),
            type_text(array.data_type)
        )));
    }
    let Some(shape) = &tensor.shape else { return Ok(()) };
    let fits = shape.dim.len() == array.dims.len()
        && shape.dim.iter().zip(&array.dims).all(|(expected, length)| {
            expected.dim_value.is_none_or(|expected| expected == *length || expected == -1)
        });
    if fits {
        return Ok(());
    }
    let expected =
        shape.dim.iter().map(|expected| match expected.dim_value.filter(|&length| length != -1) {
            Some(length) => length.to_string(),
            None => "any".to_owned(),
        });
    Err(NetworkError::InvalidNetwork(format!(
        "its input `{name}` takes an array of shape [{}], but the array has {:?}",
        expected.collect::<Vec<_>>().join(", "),
        array.dims
    )))
}

/// Returns the form of the input with the channels first, and the layout in which the model takes
/// it. `frames` is the size of the frames, and `open` the size for an input of any size.
fn input_form(
    input: &ValueInfoProto,
    graph: &GraphProto,
    frames: Option<FrameSize>,
    open: Option<FrameSize>,
) -> Result<(TensorForm, InputLayout), NetworkError> {
    let form_error = |what: String| {
        NetworkError::InvalidNetwork(format!(
            "its input `{}` must be [1, channels, height, width], {what}",
            value_name(input)
        ))
    };
    let tensor = input.r#type.as_ref().and_then(|value_type| value_type.tensor_type.as_ref());
    let kind = tensor.and_then(|tensor| tensor.elem_type).unwrap_or(data_type::FLOAT);
    if ![data_type::FLOAT, data_type::FLOAT16, data_type::BFLOAT16].contains(&kind) {
        return Err(form_error(format!(
            "of FLOAT, FLOAT16 or BFLOAT16, but it is of {}",
            data_type::type_name(kind.into())
        )));
    }
    let shape = tensor
        .and_then(|tensor| tensor.shape.as_ref())
        .ok_or_else(|| form_error("but it has no shape".to_owned()))?;
    let mut lengths = Vec::new();
    for (axis, dim) in shape.dim.iter().enumerate() {
        // The axis has any length if it gives none, or gives -1 as some exporters do. A length of 0
        // is valid in ONNX, but no frame has it.
        let length = dim.dim_value.filter(|&length| length != -1).map(|length| {
            usize::try_from(length).ok().filter(|&length| length > 0).ok_or_else(|| {
                form_error(format!(
                    "but its axis {axis} has the length {length}; lengths are 1 and more, and an axis of any length has a name instead (dim_param)"
                ))
            })
        });
        lengths.push(length.transpose()?);
    }
    let layout = input_layout(input, &lengths, graph)?;
    if layout == InputLayout::Nhwc {
        lengths[1..].rotate_right(1);
    }
    let &[batch, channels, height, width] = lengths.as_slice() else {
        return Err(form_error(format!("but it has {} axes", lengths.len())));
    };
    if batch.is_some_and(|batch| batch != 1) {
        return Err(form_error(format!("but it takes a batch of {}", batch.unwrap_or(0))));
    }
    let channels =
        channels.ok_or_else(|| form_error("but its number of channels is not given".to_owned()))?;
    if channels != 1 && channels != 3 {
        return Err(form_error(format!("with 1 or 3 channels, but it has {channels}")));
    }
    let height = height.or(open.map(|open| open.height));
    let width = width.or(open.map(|open| open.width));
    let (height, width) = match frames {
        Some(frames) => {
            let (own_height, own_width) =
                (height.unwrap_or(frames.height), width.unwrap_or(frames.width));
            if (own_height, own_width) != (frames.height, frames.width) {
                return Err(NetworkError::FrameSizeMismatch {
                    wanted: format!("{own_width}x{own_height}"),
                    found: format!("{}x{}", frames.width, frames.height),
                });
            }
            (own_height, own_width)
        }
        None => height.zip(width).ok_or_else(|| {
            let name = value_name(input);
            NetworkError::InvalidNetwork(format!(
                "its input `{name}` takes frames of any size; give one, for example letterbox=416x416"
            ))
        })?,
    };
    Ok((TensorForm::features(vec![1, channels, height, width]), layout))
}
