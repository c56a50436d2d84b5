// SPDX-License-Identifier: MIT OR Apache-2.0
//! Transposed convolution, with the size of its output as ONNX defines it.

use super::constant::Constant;
use super::node::{NodeOutput, NodeReader, checked_length, length_to_i64, output_of_tensors};
use crate::operator::{TransposedConv, TransposedWindow};
use foveate_pixels::vectors::InstructionSet;

pub(super) fn conv(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let value = node.tensor_input(0)?;
    let weights = node.required_constant(1, "weights")?;
    let bias = node.constant(2, "bias")?.map(Constant::as_floats).transpose()?;
    let &[_, _, height, width] = weights.shape.as_slice() else {
        return Err(format!(
            "its weights have {} axes; only two-dimensional convolution is supported",
            weights.shape.len()
        ));
    };
    if let Some(kernel) = node.kernel_shape()?.filter(|&kernel| kernel != [height, width]) {
        return Err(format!(
            "its kernel_shape is {kernel:?}, but its weights are {height}x{width}"
        ));
    }
    let groups = checked_length("group", node.int("group", 1))?;
    let reaches =
        [transposed_window(node, value, 0, height)?, transposed_window(node, value, 1, width)?];
    let conv = TransposedConv::new(
        &weights.shape,
        weights.as_weights()?,
        bias,
        reaches,
        groups,
        InstructionSet::detect(),
    )?;
    output_of_tensors(conv, vec![value])
}

/// Returns the window of a transposed convolution along rows (0) or columns (1).
fn transposed_window(
    node: &NodeReader<'_>,
    value: usize,
    axis: usize,
    kernel: usize,
) -> Result<TransposedWindow, String> {
    let form = (node.forms)(value);
    let [_, _, sizes @ ..] = form.shape() else {
        return Err(format!("its input must be features, not {}", form.describe()));
    };
    let &size = sizes.get(axis).ok_or("its input must be features")?;
    let along = |name: &str| match node.ints(name) {
        None => Ok(None),
        Some(&[rows, columns]) => Ok(Some([rows, columns][axis])),
        Some(ints) => Err(format!("its {name} has {} values, not 2", ints.len())),
    };
    let of = |name: &str| checked_length(name, along(name)?.unwrap_or(1));
    let (kernel, stride, dilation) =
        (checked_length("kernel", length_to_i64(kernel))?, of("strides")?, of("dilations")?);
    let more = match along("output_padding")?.unwrap_or(0) {
        more if (0..1 << 16).contains(&more) => more,
        more => return Err(format!("its output_padding is {more}; it must be 0 to 65535")),
    };
    // The sums fit, because lengths are below 2^28, and strides and kernels below 2^16.
    let (size, step) = (length_to_i64(size), length_to_i64(stride));
    let all = (size - 1) * step + more + length_to_i64((kernel - 1) * dilation) + 1;
    let mode = node.text("auto_pad", "NOTSET");
    let wanted = match (along("output_shape")?, mode.as_str()) {
        (Some(wanted), _) => Some(wanted),
        (None, "SAME_UPPER" | "SAME_LOWER") => Some(size * step),
        (None, _) => None,
    };
    let [before, after] = match (wanted, mode.as_str(), node.ints("pads")) {
        (Some(wanted), mode, _) => {
            let cut = all.checked_sub(wanted).unwrap_or(-1);
            if mode == "SAME_UPPER" { [cut / 2, cut - cut / 2] } else { [cut - cut / 2, cut / 2] }
        }
        (None, "VALID", _) | (None, "NOTSET", None) => [0, 0],
        (None, "NOTSET", Some(&[top, left, bottom, right])) => [[top, bottom], [left, right]][axis],
        (None, "NOTSET", Some(pads)) => {
            return Err(format!("its pads have {} values, not 4", pads.len()));
        }
        (None, mode, _) => return Err(format!("its auto_pad is `{mode}`")),
    };
    let cut = |pad: i64| {
        usize::try_from(pad)
            .ok()
            .filter(|&pad| pad < 1 << 16)
            .ok_or_else(|| format!("it would cut off {pad} outputs; pads are 0 to 65535"))
    };
    let (before, after) = (cut(before)?, cut(after)?);
    let outputs = usize::try_from(all - length_to_i64(before) - length_to_i64(after)).ok();
    let outputs = outputs.filter(|&outputs| outputs > 0);
    let outputs = outputs.ok_or_else(|| format!("pads of {before} and {after} leave no output"))?;
    Ok(TransposedWindow { kernel, stride, dilation, before, outputs })
}
