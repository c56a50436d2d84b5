// SPDX-License-Identifier: MIT OR Apache-2.0
//! The input of a network, and the frames that it is to take.

use crate::error::NetworkError;
use crate::form::Form;
use crate::onnx::{ValueInfoProto, data_type};

/// Width and height of the frames, for a network that takes any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameSize {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

pub(super) fn name_of(value: &ValueInfoProto) -> &str {
    value.name.as_deref().unwrap_or_default()
}

/// The form of the input: features of which the size may be open.
pub(super) fn input_form(input: &ValueInfoProto, frames: FrameSize) -> Result<Form, NetworkError> {
    let wrong = |what: String| {
        NetworkError::Network(format!(
            "its input `{}` must be [1, channels, height, width], {what}",
            name_of(input)
        ))
    };
    let tensor = input.r#type.as_ref().and_then(|of| of.tensor_type.as_ref());
    let kind = tensor.and_then(|tensor| tensor.elem_type).unwrap_or(data_type::FLOAT);
    if kind != data_type::FLOAT {
        return Err(wrong(format!(
            "of 32-bit floating-point values, but it is of type {kind} of ONNX"
        )));
    }
    let shape = tensor
        .and_then(|tensor| tensor.shape.as_ref())
        .ok_or_else(|| wrong("but it has no shape".to_owned()))?;
    let lengths: Vec<Option<usize>> = shape
        .dim
        .iter()
        .map(|dim| {
            dim.dim_value
                .and_then(|length| usize::try_from(length).ok())
                .filter(|&length| length > 0)
        })
        .collect();
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
    let (own_height, own_width) = (height.unwrap_or(frames.height), width.unwrap_or(frames.width));
    if (own_height, own_width) != (frames.height, frames.width) {
        return Err(NetworkError::Size {
            wanted: format!("{own_width}x{own_height}"),
            found: format!("{}x{}", frames.width, frames.height),
        });
    }
    Ok(Form::features(vec![1, channels, own_height, own_width]))
}
