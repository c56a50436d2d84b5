// SPDX-License-Identifier: MIT OR Apache-2.0
//! ONNX operators that change the height and width of features.

use super::constant::Constant;
use super::node::{NodeReader, checked_length};
use super::node_output::{NodeOutput, output_of_tensors};
use crate::operator::{
    DepthToSpace, DepthToSpaceOrder, NearestRounding, Resize, ResizeCoordinates, ResizeKind,
    ResizeSize, SpaceToDepth,
};

/// The scale of a Resize must be below this. The size of its output is limited separately.
const MAX_SCALE: f32 = 65536.0;

pub(super) fn resize(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    // Before version 11 a Resize has the meaning of an Upsample.
    let is_old = node.operator_name() == "Upsample" || node.opset < 11;
    let text = |name, old, new| node.text(name, if is_old { old } else { new });
    let coordinates =
        match text("coordinate_transformation_mode", "asymmetric", "half_pixel").as_str() {
            "half_pixel" => ResizeCoordinates::HalfPixel,
            "pytorch_half_pixel" => ResizeCoordinates::PytorchHalfPixel,
            "align_corners" => ResizeCoordinates::AlignCorners,
            "asymmetric" => ResizeCoordinates::Asymmetric,
            other => return Err(format!("the coordinates `{other}` are not supported")),
        };
    let nearest = match text("nearest_mode", "simple", "round_prefer_floor").as_str() {
        "round_prefer_floor" => NearestRounding::RoundPreferFloor,
        "round_prefer_ceil" => NearestRounding::RoundPreferCeil,
        "floor" => NearestRounding::Floor,
        "ceil" => NearestRounding::Ceil,
        "simple" if is_old => NearestRounding::Simple,
        other => return Err(format!("the mode `{other}` is not supported")),
    };
    let kind = match node.text("mode", "nearest").as_str() {
        "nearest" => ResizeKind::Nearest(nearest),
        // The name `bilinear` is used before version 9.
        "linear" | "bilinear" => ResizeKind::Linear,
        "cubic" => ResizeKind::Cubic {
            a: node.float("cubic_coeff_a", -0.75),
            is_inside_only: node.int("exclude_outside", 0) != 0,
        },
        other => {
            return Err(format!(
                "the mode `{other}` is not supported, only nearest, linear and cubic"
            ));
        }
    };
    if node.int("antialias", 0) != 0 {
        return Err("antialias is not supported".to_owned());
    }
    if node.text("keep_aspect_ratio_policy", "stretch") != "stretch" {
        return Err("only the keep_aspect_ratio_policy `stretch` is supported".to_owned());
    }
    let value = node.tensor_input(0)?;
    output_of_tensors(
        Resize { kind, coordinates, size: resize_size(node, value, is_old)? },
        vec![value],
    )
}

/// Returns the rows and columns of the output.
fn resize_size(node: &NodeReader<'_>, value: usize, is_old: bool) -> Result<ResizeSize, String> {
    let are_of_all = match node.ints("axes") {
        None | Some(&[0, 1, 2, 3]) => true,
        Some(&[2, 3]) => false,
        Some(axes) => {
            return Err(format!(
                "scales of the axes {axes:?} are not supported, only those of rows and columns"
            ));
        }
    };
    let scales = match node.floats("scales") {
        Some(scales) => Some(scales),
        None => node
            .constant(if is_old { 1 } else { 2 }, "scales")?
            .map(Constant::as_floats)
            .transpose()?,
    };
    let scales = scales.filter(|scales| !scales.is_empty());
    let sizes = if is_old { None } else { node.constant(3, "sizes")? };
    match (scales, sizes, are_of_all) {
        (Some(&[1.0, 1.0, rows, columns]), _, true) | (Some(&[rows, columns]), _, false)
            if rows > 0.0 && columns > 0.0 =>
        {
            match [rows, columns].into_iter().find(|&scale| scale >= MAX_SCALE) {
                None => Ok(ResizeSize::Scales([rows, columns])),
                Some(scale) => {
                    Err(format!("its scale of {scale} is too large; it must be below {MAX_SCALE}"))
                }
            }
        }
        (Some(scales), _, _) => {
            Err(format!("scales {scales:?} are not supported, only those of rows and columns"))
        }
        (None, Some(sizes), _) => match (sizes.as_integers()?, are_of_all) {
            (&[rows, columns], false) => Ok(ResizeSize::Sizes([
                checked_length("size", rows)?,
                checked_length("size", columns)?,
            ])),
            (&[1, channels, rows, columns], true)
                if (node.forms)(value).shape().get(1)
                    == usize::try_from(channels).ok().as_ref() =>
            {
                Ok(ResizeSize::Sizes([
                    checked_length("size", rows)?,
                    checked_length("size", columns)?,
                ]))
            }
            (sizes, _) => Err(format!("sizes {sizes:?} are not supported")),
        },
        (None, None, _) => Err("it has neither scales nor sizes".to_owned()),
    }
}

pub(super) fn depth_to_space(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let (side, order) = block_size_and_order(node)?;
    output_of_tensors(DepthToSpace { block_size: side, order }, vec![node.tensor_input(0)?])
}

pub(super) fn space_to_depth(node: &NodeReader<'_>) -> Result<Vec<NodeOutput>, String> {
    let (side, order) = block_size_and_order(node)?;
    output_of_tensors(SpaceToDepth { block_size: side, order }, vec![node.tensor_input(0)?])
}

/// Returns the side of the blocks of positions, and the order of the channels.
fn block_size_and_order(node: &NodeReader<'_>) -> Result<(usize, DepthToSpaceOrder), String> {
    let side = checked_length("blocksize", node.int("blocksize", 0))?;
    match node.text("mode", "DCR").as_str() {
        "DCR" => Ok((side, DepthToSpaceOrder::DepthColumnRow)),
        "CRD" => Ok((side, DepthToSpaceOrder::ColumnRowDepth)),
        other => Err(format!("the mode `{other}` is unknown; it must be DCR or CRD")),
    }
}
