// SPDX-License-Identifier: MIT OR Apache-2.0
//! The input of a network, and the frames that it is to take.

use super::names::{full_kind, is_standard, name_of, shown_name};
use crate::error::NetworkError;
use crate::form::Form;
use crate::layout::Layout;
use crate::onnx::{GraphProto, NodeProto, ValueInfoProto, data_type};

/// Width and height of the frames, for a network that takes any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSize {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// What puts the channels first.
const CHANNELS_FIRST: [i64; 4] = [0, 3, 1, 2];

/// Whether a node does nothing but to put the channels of a value first.
pub(super) fn puts_channels_first(node: &NodeProto, value: &str) -> bool {
    let order = node.attribute.iter().find(|attribute| attribute.name.as_deref() == Some("perm"));
    is_standard(node.domain.as_deref())
        && node.op_type.as_deref() == Some("Transpose")
        && node.input == [value]
        && node.output.len() == 1
        && order.is_some_and(|order| order.ints == CHANNELS_FIRST)
}

/// The layout of the input, from its shape and from what takes it.
fn layout(
    input: &ValueInfoProto,
    lengths: &[Option<usize>],
    graph: &GraphProto,
) -> Result<Layout, NetworkError> {
    let is_colours = |length: Option<usize>| matches!(length, Some(1 | 3));
    let &[_, second, _, last] = lengths else { return Ok(Layout::Nchw) };
    if is_colours(second) || !is_colours(last) {
        return Ok(Layout::Nchw);
    }
    let name = name_of(input);
    let takes = |node: &NodeProto| node.input.iter().any(|taken| taken == name);
    let mut odd = graph.node.iter().enumerate();
    let odd = odd.find(|(_, node)| takes(node) && !puts_channels_first(node, name));
    let odd = odd.map(|(index, node)| {
        format!("node `{}` ({}) takes it so", shown_name(node, index), full_kind(node))
    });
    let is_output = graph.output.iter().any(|output| name_of(output) == name);
    match odd.or_else(|| is_output.then(|| "it is an output, too".to_owned())) {
        None => Ok(Layout::Nhwc),
        Some(odd) => Err(NetworkError::Network(format!(
            "its input `{name}` is [1, height, width, channels], and {odd}; only a Transpose of perm {CHANNELS_FIRST:?} may take such an input. Export it with channels first, as tf2onnx does with --inputs-as-nchw {name}"
        ))),
    }
}

/// The form of the input with channels first, features of which the size may be open, and the layout in which the model takes it.
pub(super) fn input_form(
    input: &ValueInfoProto,
    graph: &GraphProto,
    frames: Option<FrameSize>,
) -> Result<(Form, Layout), NetworkError> {
    let wrong = |what: String| {
        NetworkError::Network(format!(
            "its input `{}` must be [1, channels, height, width], {what}",
            name_of(input)
        ))
    };
    let tensor = input.r#type.as_ref().and_then(|of| of.tensor_type.as_ref());
    let kind = tensor.and_then(|tensor| tensor.elem_type).unwrap_or(data_type::FLOAT);
    if ![data_type::FLOAT, data_type::FLOAT16, data_type::BFLOAT16].contains(&kind) {
        return Err(wrong(format!(
            "of floating-point values of 32 or 16 bits, but it is of type {kind} of ONNX"
        )));
    }
    let shape = tensor
        .and_then(|tensor| tensor.shape.as_ref())
        .ok_or_else(|| wrong("but it has no shape".to_owned()))?;
    let mut lengths = Vec::new();
    for (axis, dim) in shape.dim.iter().enumerate() {
        // Without a length the axis is open. A length of 0 is one, and no picture has it.
        let length = dim.dim_value.map(|length| {
            usize::try_from(length).ok().filter(|&length| length > 0).ok_or_else(|| {
                wrong(format!(
                    "but its axis {axis} has the length {length}; lengths are 1 and more, and an axis of any length has a name instead (dim_param)"
                ))
            })
        });
        lengths.push(length.transpose()?);
    }
    let layout = layout(input, &lengths, graph)?;
    if layout == Layout::Nhwc {
        lengths[1..].rotate_right(1);
    }
    let &[batch, channels, height, width] = lengths.as_slice() else {
        return Err(wrong(format!("but it has {} axes", lengths.len())));
    };
    if batch.is_some_and(|batch| batch != 1) {
        return Err(wrong(format!("but it takes {} pictures at once", batch.unwrap_or(0))));
    }
    let channels = channels.ok_or_else(|| wrong("but its channels are open".to_owned()))?;
    if channels != 1 && channels != 3 {
        return Err(wrong(format!("with 1 or 3 channels, but it has {channels}")));
    }
    let (height, width) = match frames {
        Some(frames) => {
            let (own_height, own_width) =
                (height.unwrap_or(frames.height), width.unwrap_or(frames.width));
            if (own_height, own_width) != (frames.height, frames.width) {
                return Err(NetworkError::Size {
                    wanted: format!("{own_width}x{own_height}"),
                    found: format!("{}x{}", frames.width, frames.height),
                });
            }
            (own_height, own_width)
        }
        None => height.zip(width).ok_or_else(|| {
            let name = name_of(input);
            NetworkError::Network(format!(
                "its input `{name}` takes pictures of any size; say which, for example letterbox=416x416"
            ))
        })?,
    };
    Ok((Form::features(vec![1, channels, height, width]), layout))
}
