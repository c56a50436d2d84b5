// SPDX-License-Identifier: MIT OR Apache-2.0
//! Operators of ONNX that give features another size.

use super::made::{Made, one};
use super::node::{NodeReader, positive};
use crate::operator::{Coordinates, Nearest, Resize, ResizeKind, Size};

/// The largest scale of a Resize is below this; what it makes is limited, too.
const MAX_SCALE: f32 = 65536.0;

pub(super) fn resize(node: &NodeReader<'_>) -> Result<Vec<Made>, String> {
    let coordinates = match node
        .text(
            "coordinate_transformation_mode",
            if node.kind() == "Upsample" { "asymmetric" } else { "half_pixel" },
        )
        .as_str()
    {
        "half_pixel" => Coordinates::HalfPixel,
        "pytorch_half_pixel" => Coordinates::PytorchHalfPixel,
        "align_corners" => Coordinates::AlignCorners,
        "asymmetric" => Coordinates::Asymmetric,
        other => return Err(format!("the coordinates `{other}` are not supported")),
    };
    let nearest = match node
        .text(
            "nearest_mode",
            if node.kind() == "Upsample" { "floor" } else { "round_prefer_floor" },
        )
        .as_str()
    {
        "round_prefer_floor" => Nearest::RoundPreferFloor,
        "round_prefer_ceil" => Nearest::RoundPreferCeil,
        "floor" => Nearest::Floor,
        "ceil" => Nearest::Ceil,
        other => return Err(format!("the mode `{other}` is not supported")),
    };
    let kind = match node.text("mode", "nearest").as_str() {
        "nearest" => ResizeKind::Nearest(nearest),
        "linear" => ResizeKind::Linear,
        other => {
            return Err(format!("the mode `{other}` is not supported, only nearest and linear"));
        }
    };
    if node.int("antialias", 0) != 0 {
        return Err("antialias is not supported".to_owned());
    }
    if node.text("keep_aspect_ratio_policy", "stretch") != "stretch" {
        return Err("only the keep_aspect_ratio_policy `stretch` is supported".to_owned());
    }
    if node.ints("axes").is_some_and(|axes| axes != [0, 1, 2, 3]) {
        return Err("scales of some axes are not supported, only those of all four".to_owned());
    }
    let value = node.value(0)?;
    let scales_at = if node.kind() == "Upsample" { 1 } else { 2 };
    let scales = node.constant(scales_at, "scales")?.filter(|scales| scales.values.count() > 0);
    let size = match (scales, node.constant(3, "sizes")?) {
        (Some(scales), _) => match *scales.as_floats()? {
            [1.0, 1.0, rows, columns] if rows > 0.0 && columns > 0.0 => {
                if let Some(scale) = [rows, columns].into_iter().find(|&scale| scale >= MAX_SCALE) {
                    return Err(format!(
                        "its scale of {scale} is too large; it must be below {MAX_SCALE}"
                    ));
                }
                Size::Scales([rows, columns])
            }
            ref scales => {
                return Err(format!(
                    "scales {scales:?} are not supported, only those of rows and columns"
                ));
            }
        },
        (None, Some(sizes)) => match *sizes.as_integers()? {
            [1, channels, rows, columns]
                if (node.forms)(value).shape().get(1)
                    == usize::try_from(channels).ok().as_ref() =>
            {
                Size::Sizes([positive("size", rows)?, positive("size", columns)?])
            }
            ref sizes => return Err(format!("sizes {sizes:?} are not supported")),
        },
        (None, None) => return Err("it has neither scales nor sizes".to_owned()),
    };
    one(Resize { kind, coordinates, size }, vec![value])
}
