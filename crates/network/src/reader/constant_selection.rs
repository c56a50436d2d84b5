// SPDX-License-Identifier: MIT OR Apache-2.0
//! Constants whose values are selected from another constant. Exporters use such nodes, for
//! example, to compute the widths of padding from a list.

use super::constant::Constant;
use super::constant_values::ConstantValues;
use super::model_folder::ModelFolder;
use super::node::{NodeReader, index_from_start, length_to_i64};
use crate::tensor::{MAX_AXES, checked_element_count};

/// Returns a constant of this shape that repeats one value.
pub(super) fn fill_constant(node: &NodeReader<'_>, shape: &Constant) -> Result<Constant, String> {
    let shape: Option<Vec<usize>> =
        shape.as_integers()?.iter().map(|&length| usize::try_from(length).ok()).collect();
    let shape = shape.filter(|shape| shape.len() <= MAX_AXES);
    let shape = shape.ok_or("its shape has too many axes, or a negative length")?;
    let value = node.tensor("value")?.unwrap_or_else(|| Constant::floats(vec![1], vec![0.0]));
    if value.values.value_count() != 1 {
        return Err(format!("its value has {} values, not 1", value.values.value_count()));
    }
    let count = node.folder.check_room(&shape, &value.values)?;
    let values = match &value.values {
        ConstantValues::Floats(values) => ConstantValues::Floats(vec![values[0]; count]),
        ConstantValues::Integers(values) => ConstantValues::Integers(vec![values[0]; count]),
    };
    Ok(Constant { shape, values, data_type: value.data_type })
}

/// Returns the values in another shape. One length may be -1, and then follows from the others. A
/// length of 0 is that of the input.
pub(super) fn reshape_constant(
    node: &NodeReader<'_>,
    from: &Constant,
    shape: &Constant,
) -> Result<Constant, String> {
    let wanted = shape.as_integers()?;
    if node.int("allowzero", 0) != 0 && wanted.contains(&0) {
        return Err(format!(
            "its shape {wanted:?} holds a 0 and allowzero is 1, so that its output is empty"
        ));
    }
    let misfit_message = || format!("its input {:?} cannot become {wanted:?}", from.shape);
    if wanted.len() > MAX_AXES {
        return Err(misfit_message());
    }
    let length = |(axis, &length): (usize, &i64)| match length {
        -1 => Some(1),
        0 => from.shape.get(axis).copied(),
        length => usize::try_from(length).ok(),
    };
    let shape: Option<Vec<usize>> = wanted.iter().enumerate().map(length).collect();
    let mut shape = shape.ok_or_else(misfit_message)?;
    if let Some(inferred_axis) = wanted.iter().position(|&length| length == -1) {
        let known = checked_element_count(&shape);
        shape[inferred_axis] = from
            .values
            .value_count()
            .checked_div(known.ok_or_else(misfit_message)?)
            .ok_or_else(misfit_message)?;
    }
    if checked_element_count(&shape) != Some(from.values.value_count()) {
        return Err(misfit_message());
    }
    Ok(Constant { shape, ..from.clone() })
}

/// Permutes the axes. Without `perm` their order is reversed.
pub(super) fn transpose_constant(
    node: &NodeReader<'_>,
    from: &Constant,
) -> Result<Constant, String> {
    let axes = from.shape.len();
    let order: Vec<usize> = match node.ints("perm") {
        None => (0..axes).rev().collect(),
        Some(perm) => perm.iter().filter_map(|&axis| usize::try_from(axis).ok()).collect(),
    };
    let mut sorted = order.clone();
    sorted.sort_unstable();
    if sorted != (0..axes).collect::<Vec<_>>() {
        return Err(format!("its perm does not name each of {axes} axes once"));
    }
    let shape = order.iter().map(|&axis| from.shape[axis]).collect();
    select_values(node.folder, from, shape, |place| {
        (0..axes).map(|axis| place[axis_position(&order, axis)] * stride(&from.shape, axis)).sum()
    })
}

/// Takes slices along some axes, with steps that may be negative.
pub(super) fn slice_constant(node: &NodeReader<'_>, from: &Constant) -> Result<Constant, String> {
    let starts = node.ints_or_input("starts", 1)?.ok_or("it has no starts")?;
    let ends = node.ints_or_input("ends", 2)?.ok_or("it has no ends")?;
    let axes = node
        .ints_or_input("axes", 3)?
        .unwrap_or_else(|| (0..length_to_i64(starts.len())).collect());
    let steps = node.ints_or_input("steps", 4)?.unwrap_or_else(|| vec![1; starts.len()]);
    if [ends.len(), axes.len(), steps.len()].iter().any(|&length| length != starts.len()) {
        return Err("its starts, ends, axes and steps differ in length".to_owned());
    }
    let (mut shape, mut first) = (from.shape.clone(), vec![0; from.shape.len()]);
    let mut step = vec![1; from.shape.len()];
    for (at, &axis) in axes.iter().enumerate() {
        let axis = usize::try_from(index_from_start(axis, shape.len()))
            .ok()
            .filter(|&axis| axis < from.shape.len())
            .ok_or_else(|| format!("its axis {axis} is outside of {:?}", from.shape))?;
        let (start, count) = slice_bounds(starts[at], ends[at], steps[at], from.shape[axis])?;
        shape[axis] = count;
        (first[axis], step[axis]) = (start, steps[at]);
    }
    select_values(node.folder, from, shape, |place| {
        let along = |axis: usize| {
            let at = first[axis] + length_to_i64(place[axis]) * step[axis];
            usize::try_from(at).expect("inside") * stride(&from.shape, axis)
        };
        (0..place.len()).map(along).sum()
    })
}

/// Returns the first element of a slice of an axis and the number of its elements, as ONNX defines
/// them.
pub(super) fn slice_bounds(
    start: i64,
    end: i64,
    step: i64,
    length: usize,
) -> Result<(i64, usize), String> {
    let (start, end, all) =
        (index_from_start(start, length), index_from_start(end, length), length_to_i64(length));
    // With a negative step the end may lie in front of the first element, at -1.
    let (low, high) = if step < 0 { (-1, all - 1) } else { (0, all) };
    let (start, end) = (start.clamp(low.max(0), high.max(0)), end.clamp(low, high));
    let distance = if step < 0 { start - end } else { end - start };
    let distance = usize::try_from(distance.max(0)).expect("not negative");
    match usize::try_from(step.unsigned_abs()) {
        Ok(0) => Err("its step is 0".to_owned()),
        Ok(step) => Ok((start, distance.div_ceil(step))),
        Err(_) => Err(format!("its step is {step}, which is not supported")),
    }
}

/// Broadcasts a constant to a shape. The constant is repeated along axes of one element, and along
/// new axes in front.
pub(super) fn broadcast_constant(
    folder: &ModelFolder,
    source: &Constant,
    shape: &[usize],
) -> Result<Constant, String> {
    if source.shape == shape {
        return Ok(source.clone());
    }
    let new_axes = shape.len().checked_sub(source.shape.len());
    let fits = |new_axes: &usize| {
        source
            .shape
            .iter()
            .zip(&shape[*new_axes..])
            .all(|(&length, &wanted)| length == wanted || length == 1)
    };
    let new_axes = new_axes
        .filter(fits)
        .ok_or_else(|| format!("{:?} cannot become {shape:?}", source.shape))?;
    select_values(folder, source, shape.to_vec(), |place| {
        let along = |axis: usize| match source.shape[axis] {
            1 => 0,
            _ => place[axis + new_axes] * stride(&source.shape, axis),
        };
        (0..source.shape.len()).map(along).sum()
    })
}

/// Returns the elements of an axis at these indices.
pub(super) fn gather_constant(
    node: &NodeReader<'_>,
    from: &Constant,
    indices: &Constant,
) -> Result<Constant, String> {
    let axis = index_from_start(node.int("axis", 0), from.shape.len());
    let axis = usize::try_from(axis).ok().filter(|&axis| axis < from.shape.len());
    let axis = axis.ok_or("its axis is outside of the axes of its input")?;
    let length = from.shape[axis];
    let index = |&index: &i64| {
        let at = usize::try_from(index_from_start(index, length)).ok().filter(|&at| at < length);
        at.ok_or_else(|| format!("its index {index} is outside of {length} elements"))
    };
    let positions: Vec<usize> =
        indices.as_integers()?.iter().map(index).collect::<Result<_, _>>()?;
    let (front, behind) = (&from.shape[..axis], &from.shape[axis + 1..]);
    if front.len() + indices.shape.len() + behind.len() > MAX_AXES {
        return Err(format!("its output has more than {MAX_AXES} axes"));
    }
    let shape = [front, indices.shape.as_slice(), behind].concat();
    // The values are selected as if all indices were one axis.
    let (count, inner) = (positions.len(), behind.iter().product::<usize>());
    let gathered =
        select_values(node.folder, from, vec![front.iter().product(), count, inner], |place| {
            (place[0] * length + positions[place[1]]) * inner + place[2]
        })?;
    Ok(Constant { shape, ..gathered })
}

/// Concatenates constants along an axis.
pub(super) fn concat_constants(
    node: &NodeReader<'_>,
    parts: &[&Constant],
) -> Result<Constant, String> {
    let first = parts[0];
    let axis = usize::try_from(index_from_start(node.int("axis", 0), first.shape.len()))
        .ok()
        .filter(|&axis| axis < first.shape.len())
        .ok_or("its axis is outside of the axes of its input")?;
    let fits = |part: &&Constant| {
        let own = part.shape.iter().zip(&first.shape).enumerate();
        part.shape.len() == first.shape.len()
            && own.into_iter().all(|(at, (a, b))| at == axis || a == b)
    };
    if !parts.iter().all(fits) {
        return Err("its inputs do not fit together".to_owned());
    }
    let mut shape = first.shape.clone();
    let length = parts.iter().try_fold(0usize, |sum, part| sum.checked_add(part.shape[axis]));
    shape[axis] = length.ok_or("its output is too large")?;
    node.folder.check_room(&shape, &first.values)?;
    let outer: usize = shape[..axis].iter().product();
    fn lines<T: Copy>(parts: &[&[T]], outer: usize) -> Vec<T> {
        let line = |line| {
            parts.iter().flat_map(move |part: &&[T]| {
                let own = part.len() / outer;
                part[line * own..(line + 1) * own].iter().copied()
            })
        };
        (0..outer).flat_map(line).collect()
    }
    let values = match &first.values {
        ConstantValues::Integers(_) => {
            let parts =
                parts.iter().map(|part| part.as_integers()).collect::<Result<Vec<_>, _>>()?;
            ConstantValues::Integers(lines(&parts, outer))
        }
        ConstantValues::Floats(_) => {
            let parts = parts.iter().map(|part| part.as_floats()).collect::<Result<Vec<_>, _>>()?;
            ConstantValues::Floats(lines(&parts, outer))
        }
    };
    Ok(Constant { shape, values, data_type: first.data_type })
}

/// Returns the position of an axis in a permutation.
fn axis_position(order: &[usize], axis: usize) -> usize {
    order.iter().position(|&other| other == axis).expect("every axis is named")
}

fn stride(shape: &[usize], axis: usize) -> usize {
    shape[axis + 1..].iter().product()
}

/// Returns a constant whose value at each index is selected from `source`: `number_at` returns the
/// number of that value.
fn select_values(
    folder: &ModelFolder,
    source: &Constant,
    shape: Vec<usize>,
    number_at: impl Fn(&[usize]) -> usize,
) -> Result<Constant, String> {
    let count = folder.check_room(&shape, &source.values)?;
    let mut index = vec![0; shape.len()];
    let numbers = (0..count).map(|_| {
        let number = number_at(&index);
        advance_index(&mut index, &shape);
        number
    });
    let values = match &source.values {
        ConstantValues::Floats(values) => {
            ConstantValues::Floats(numbers.map(|at| values[at]).collect())
        }
        ConstantValues::Integers(values) => {
            ConstantValues::Integers(numbers.map(|at| values[at]).collect())
        }
    };
    Ok(Constant { shape, values, data_type: source.data_type })
}

/// Advances to the next index of a shape, in row-major order. The first index follows the last.
fn advance_index(index: &mut [usize], shape: &[usize]) {
    for (coordinate, &length) in index.iter_mut().zip(shape).rev() {
        *coordinate += 1;
        if *coordinate < length {
            return;
        }
        *coordinate = 0;
    }
}
