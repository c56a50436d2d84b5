// SPDX-License-Identifier: MIT OR Apache-2.0
//! Selection of elements along each axis, in any order: slices, single indices, and padding.

use super::{Job, Operator, moved, only, wanted};
use crate::element::{Encoding, typed};
use crate::form::Form;
use crate::mask::Mask;
use crate::tensor::Tensor;
use crate::values::Number;

/// The elements that are taken from an axis.
#[derive(Clone, Debug)]
pub(crate) enum Picked {
    All,
    /// The input index of each output index, or [`PADDING`].
    At(Vec<u32>),
}

/// The index of padding. No axis is so long.
const PADDING: u32 = u32::MAX;

impl Picked {
    /// Returns the selection of these input indices, where `None` stands for padding.
    pub(crate) fn at(places: impl Iterator<Item = Option<usize>>) -> Self {
        let place = |at: Option<usize>| at.and_then(|at| u32::try_from(at).ok());
        Self::At(places.map(|at| place(at).unwrap_or(PADDING)).collect())
    }

    fn count(&self, length: usize) -> usize {
        match self {
            Self::All => length,
            Self::At(places) => places.len(),
        }
    }

    /// Returns the range of inputs that each output sees, as the first and the last input.
    fn ranges(&self, length: usize) -> Vec<(usize, usize)> {
        match self {
            Self::All => (0..length).map(|at| (at, at)).collect(),
            // The range from 1 to 0 is empty.
            Self::At(places) => {
                places.iter().map(|&at| element(at).map_or((1, 0), |at| (at, at))).collect()
            }
        }
    }
}

/// Returns the index of an element, or `None` for padding.
#[inline(always)]
fn element(place: u32) -> Option<usize> {
    (place != PADDING).then_some(place as usize)
}

/// A selection of elements along each axis.
#[derive(Clone, Debug)]
pub(crate) struct Pick {
    /// The selected elements of each axis of the input.
    pub(crate) axes: Vec<Picked>,
    /// An axis of which a single element is taken, and which the output does not have.
    pub(crate) dropped: Option<usize>,
    /// The padding: a tensor of one value.
    pub(crate) padding: Option<Tensor>,
}

impl Pick {
    /// Returns a selection along one of `axes` axes, which takes all elements of the others.
    pub(crate) fn along(axis: usize, picked: Picked, axes: usize) -> Self {
        let mut all = vec![Picked::All; axes];
        all[axis] = picked;
        Self { axes: all, dropped: None, padding: None }
    }

    /// The lengths of all axes, including the one that the output does not have.
    fn lengths(&self, input: &Form) -> Vec<usize> {
        self.axes.iter().zip(input.shape()).map(|(picked, &length)| picked.count(length)).collect()
    }
}

impl Operator for Pick {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let input = only(inputs)?;
        let fits = |(picked, &length): (&Picked, &usize)| match picked {
            Picked::All => true,
            Picked::At(places) => places.iter().filter_map(|&at| element(at)).all(|at| at < length),
        };
        if self.axes.len() != input.shape().len() || !self.axes.iter().zip(input.shape()).all(fits)
        {
            return Err(format!("it takes elements that {} does not have", input.describe()));
        }
        let mut shape = self.lengths(input);
        let axes = input.axes();
        let Some(dropped) = self.dropped else { return Ok(Form::at(shape, axes)) };
        shape.remove(dropped);
        let start = axes.start - usize::from(dropped < axes.start);
        let count = axes.len() - usize::from(axes.contains(&dropped));
        Ok(Form::at(shape, if count == 0 { 0..0 } else { start..start + count }))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        let own = self.padding.as_ref().map(|padding| padding.form().encoding().element);
        match (inputs.first(), own) {
            (Some(input), Some(own)) if input.element != own => Err(wanted(own, input.element)),
            _ => moved(inputs),
        }
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        let (form, mask) = inputs[0];
        let ranges = |axis: usize| self.axes[axis].ranges(form.shape()[axis]);
        let axes = form.axes();
        let seen = match axes.len() {
            2 => mask.between(&ranges(axes.start), &ranges(axes.start + 1)),
            1 => mask.between(&[(0, 0)], &ranges(axes.start)),
            _ => return mask.clone(),
        };
        // If one column of each row is taken and its axis is dropped, the rows become a row of
        // positions.
        if (seen.height(), seen.width()) == (output.height(), output.width()) {
            return seen;
        }
        let is_row = seen.width() == 1;
        Mask::from_fn(output.height(), output.width(), |x, y| {
            if is_row { seen.contains(0, x) } else { seen.contains(x, y) }
        })
    }

    fn compute(&self, job: Job<'_>) {
        typed!(job.form.encoding().element, T => self.take::<T>(job));
    }
}

impl Pick {
    fn take<T: Number>(&self, job: Job<'_>) {
        let input = job.inputs[0];
        let (values, steps) = (input.values::<T>(), input.form().steps());
        let lengths = self.lengths(input.form());
        let padding = self.padding.as_ref().map_or(T::default(), |value| value.values::<T>()[0]);
        // Behind the last axis with a selection, neighbors in the input are neighbors in the
        // output.
        let line = self.axes.iter().rposition(|picked| matches!(picked, Picked::At(_)));
        let Some(line) = line else {
            return job.fill::<T>(|run, to| to.copy_from_slice(&values[run]));
        };
        let (length, solid) = (lengths[line], steps[line]);
        let Picked::At(places) = &self.axes[line] else { unreachable!("it was found") };
        // Returns the start of a line of the input, or `None` if an axis in front is in the
        // padding.
        let base = |line_number: usize| -> Option<usize> {
            let (mut rest, mut at) = (line_number, 0);
            for axis in (0..line).rev() {
                let own = rest % lengths[axis];
                rest /= lengths[axis];
                let from = match &self.axes[axis] {
                    Picked::All => own,
                    Picked::At(places) => element(places[own])?,
                };
                at += from * steps[axis];
            }
            Some(at)
        };
        let whole = length * solid;
        job.fill::<T>(|run, to| {
            let (mut start, mut to) = (run.start, to);
            while !to.is_empty() {
                let inside = start % whole;
                let (own, rest) = to.split_at_mut(to.len().min(whole - inside));
                start += own.len();
                to = rest;
                match base((start - 1) / whole) {
                    None => own.fill(padding),
                    Some(at) => pick_line(&values[at..], places, solid, inside, own, padding),
                }
            }
        });
    }
}

/// Fills a part of a line of the output, from its value `first` on.
fn pick_line<T: Number>(
    values: &[T],
    places: &[u32],
    solid: usize,
    first: usize,
    to: &mut [T],
    padding: T,
) {
    if solid == 1 {
        for (to, place) in to.iter_mut().zip(&places[first..]) {
            *to = element(*place).map_or(padding, |at| values[at]);
        }
        return;
    }
    let (mut at, mut to) = (first, to);
    while !to.is_empty() {
        let inside = at % solid;
        let (own, rest) = to.split_at_mut(to.len().min(solid - inside));
        match element(places[at / solid]) {
            None => own.fill(padding),
            Some(place) => own.copy_from_slice(&values[place * solid + inside..][..own.len()]),
        }
        at += own.len();
        to = rest;
    }
}
