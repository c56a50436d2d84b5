// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps the positions of an input to those of an output with other axes.

use crate::mask::Mask;
use crate::tensor_form::TensorForm;
use std::ops::Range;

/// Returns the positions of an output that depend on those of an input. `to` maps an axis of the
/// input to an axis of the output, or to `None`. Along an axis of positions of both, an output
/// depends on the input at its own index. Along an axis that is an axis of positions of the input
/// alone, an output depends on all inputs. An axis of one element is repeated.
pub(crate) fn aligned_mask(
    (form, mask): (&TensorForm, &Mask),
    output: &TensorForm,
    to: impl Fn(usize) -> Option<usize>,
) -> Mask {
    if !form.has_positions() || !output.has_positions() {
        return full_if(!mask.is_empty(), output);
    }
    // Returns the source of the index for the rows or for the columns of the input.
    let index_source = |axis: Option<usize>| match axis.and_then(&to) {
        Some(output_axis)
            if output.position_axes().len() == 2 && output_axis == output.position_axes().start =>
        {
            AxisIndexSource::Row
        }
        Some(output_axis)
            if output_axis + 1 == output.position_axes().end && output.has_positions() =>
        {
            AxisIndexSource::Column
        }
        Some(_) | None => AxisIndexSource::All,
    };
    let rows =
        index_source((form.position_axes().len() == 2).then_some(form.position_axes().start));
    let columns = index_source(form.position_axes().end.checked_sub(1));
    let is_same = (form.height(), form.width()) == (output.height(), output.width());
    match (rows, columns) {
        (AxisIndexSource::Row, AxisIndexSource::Column) if is_same => mask.clone(),
        (AxisIndexSource::All, AxisIndexSource::Column)
            if is_same && form.position_axes().len() == 1 =>
        {
            mask.clone()
        }
        _ => Mask::from_fn(output.height(), output.width(), |x, y| {
            let range = |along: AxisIndexSource, length: usize| -> Range<usize> {
                let at = match along {
                    AxisIndexSource::All => return 0..length,
                    AxisIndexSource::Row => y,
                    AxisIndexSource::Column => x,
                };
                if length == 1 { 0..1 } else { at..at + 1 }
            };
            mask.has_any(range(rows, form.height()), range(columns, form.width()))
        }),
    }
}

/// The source of the index along an axis of positions of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AxisIndexSource {
    Row,
    Column,
    /// All indices count.
    All,
}

/// Returns all positions if the condition holds, and none otherwise.
pub(crate) fn full_if(is: bool, output: &TensorForm) -> Mask {
    if is {
        Mask::full(output.height(), output.width())
    } else {
        Mask::empty(output.height(), output.width())
    }
}
