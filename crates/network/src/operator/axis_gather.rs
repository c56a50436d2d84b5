// SPDX-License-Identifier: MIT OR Apache-2.0
//! Selection of elements along each axis, in any order: slices, single indices, and padding.

use super::{Operator, OperatorJob, moved_encoding, only_input, wrong_element_message};
use crate::element::{Encoding, with_element_type};
use crate::mask::Mask;
use crate::tensor::{Tensor, TensorForm};
use crate::values::TensorNumber;

/// The elements that are taken from an axis.
#[derive(Clone, Debug)]
pub(crate) enum AxisSelection {
    All,
    /// The input index of each output index, or [`PADDING`].
    Indices(Vec<u32>),
}

/// The index of padding. No axis is so long.
const PADDING: u32 = u32::MAX;

impl AxisSelection {
    /// Returns the selection of these input indices, where `None` stands for padding.
    pub(crate) fn from_indices(places: impl Iterator<Item = Option<usize>>) -> Self {
        let place = |at: Option<usize>| at.and_then(|at| u32::try_from(at).ok());
        Self::Indices(places.map(|at| place(at).unwrap_or(PADDING)).collect())
    }

    fn count(&self, length: usize) -> usize {
        match self {
            Self::All => length,
            Self::Indices(places) => places.len(),
        }
    }

    /// Returns the range of inputs that each output sees, as the first and the last input.
    fn ranges(&self, length: usize) -> Vec<(usize, usize)> {
        match self {
            Self::All => (0..length).map(|at| (at, at)).collect(),
            // The range from 1 to 0 is empty.
            Self::Indices(places) => {
                places.iter().map(|&at| input_element(at).map_or((1, 0), |at| (at, at))).collect()
            }
        }
    }
}

/// Returns the index of an element, or `None` for padding.
#[inline(always)]
fn input_element(place: u32) -> Option<usize> {
    (place != PADDING).then_some(place as usize)
}

/// A selection of elements along each axis.
#[derive(Clone, Debug)]
pub(crate) struct AxisGather {
    /// The selected elements of each axis of the input.
    pub(crate) axes: Vec<AxisSelection>,
    /// An axis of which a single element is taken, and which the output does not have.
    pub(crate) dropped_axis: Option<usize>,
    pub(crate) padding: Option<Tensor>,
}

impl AxisGather {
    /// Returns a selection along one of `axes` axes, which takes all elements of the others.
    pub(crate) fn along_axis(axis: usize, selection: AxisSelection, axes: usize) -> Self {
        let mut all = vec![AxisSelection::All; axes];
        all[axis] = selection;
        Self { axes: all, dropped_axis: None, padding: None }
    }

    /// The lengths of all axes, including the one that the output does not have.
    fn lengths(&self, input: &TensorForm) -> Vec<usize> {
        self.axes
            .iter()
            .zip(input.shape())
            .map(|(selection, &length)| selection.count(length))
            .collect()
    }
}

impl Operator for AxisGather {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let input = only_input(inputs)?;
        let fits = |(selection, &length): (&AxisSelection, &usize)| match selection {
            AxisSelection::All => true,
            AxisSelection::Indices(places) => {
                places.iter().filter_map(|&at| input_element(at)).all(|at| at < length)
            }
        };
        if self.axes.len() != input.shape().len() || !self.axes.iter().zip(input.shape()).all(fits)
        {
            return Err(format!("it reads elements that {} does not have", input.describe()));
        }
        let mut shape = self.lengths(input);
        let axes = input.position_axes();
        let Some(dropped) = self.dropped_axis else {
            return Ok(TensorForm::with_positions(shape, axes));
        };
        shape.remove(dropped);
        let start = axes.start - usize::from(dropped < axes.start);
        let count = axes.len() - usize::from(axes.contains(&dropped));
        Ok(TensorForm::with_positions(shape, if count == 0 { 0..0 } else { start..start + count }))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        let padding_element =
            self.padding.as_ref().map(|padding| padding.form().encoding().element);
        match (inputs.first(), padding_element) {
            (Some(input), Some(padding_element)) if input.element != padding_element => {
                Err(wrong_element_message(padding_element, input.element))
            }
            _ => moved_encoding(inputs),
        }
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let (form, mask) = inputs[0];
        let ranges = |axis: usize| self.axes[axis].ranges(form.shape()[axis]);
        let axes = form.position_axes();
        let dependent = match axes.len() {
            2 => mask.outputs_of_ranges(&ranges(axes.start), &ranges(axes.start + 1)),
            1 => mask.outputs_of_ranges(&[(0, 0)], &ranges(axes.start)),
            _ => return mask.clone(),
        };
        // If a single column is taken and its axis is dropped, the rows of the input become the
        // columns of the output.
        if (dependent.height(), dependent.width()) == (output.height(), output.width()) {
            return dependent;
        }
        let is_row = dependent.width() == 1;
        Mask::from_fn(output.height(), output.width(), |x, y| {
            if is_row { dependent.contains(0, x) } else { dependent.contains(x, y) }
        })
    }

    fn compute(&self, job: OperatorJob<'_>) {
        with_element_type!(job.form.encoding().element, T => self.gather::<T>(job));
    }
}

impl AxisGather {
    fn gather<T: TensorNumber>(&self, job: OperatorJob<'_>) {
        let input = job.inputs[0];
        let (values, steps) = (input.values::<T>(), input.form().strides());
        let lengths = self.lengths(input.form());
        let padding = self.padding.as_ref().map_or(T::default(), |value| value.values::<T>()[0]);
        // Behind the last axis with a selection, neighbors in the input are neighbors in the
        // output.
        let line =
            self.axes.iter().rposition(|selection| matches!(selection, AxisSelection::Indices(_)));
        let Some(line) = line else {
            return job.fill::<T>(|run, to| to.copy_from_slice(&values[run]));
        };
        let (length, run_length) = (lengths[line], steps[line]);
        let AxisSelection::Indices(places) = &self.axes[line] else { unreachable!("it was found") };
        // Returns the start of a line of the input, or `None` if an axis in front is in the
        // padding.
        let line_start = |line_number: usize| -> Option<usize> {
            let (mut rest, mut at) = (line_number, 0);
            for axis in (0..line).rev() {
                let element = rest % lengths[axis];
                rest /= lengths[axis];
                let from = match &self.axes[axis] {
                    AxisSelection::All => element,
                    AxisSelection::Indices(places) => input_element(places[element])?,
                };
                at += from * steps[axis];
            }
            Some(at)
        };
        let line_values = length * run_length;
        job.fill::<T>(|run, to| {
            let (mut start, mut to) = (run.start, to);
            while !to.is_empty() {
                let inside = start % line_values;
                let (part, rest) = to.split_at_mut(to.len().min(line_values - inside));
                start += part.len();
                to = rest;
                match line_start((start - 1) / line_values) {
                    None => part.fill(padding),
                    Some(at) => {
                        gather_line(&values[at..], places, run_length, inside, part, padding);
                    }
                }
            }
        });
    }
}

/// Fills a part of a line of the output, from its value `first` on.
fn gather_line<T: TensorNumber>(
    values: &[T],
    places: &[u32],
    run_length: usize,
    first: usize,
    to: &mut [T],
    padding: T,
) {
    if run_length == 1 {
        for (to, place) in to.iter_mut().zip(&places[first..]) {
            *to = input_element(*place).map_or(padding, |at| values[at]);
        }
        return;
    }
    let (mut at, mut to) = (first, to);
    while !to.is_empty() {
        let inside = at % run_length;
        let (part, rest) = to.split_at_mut(to.len().min(run_length - inside));
        match input_element(places[at / run_length]) {
            None => part.fill(padding),
            Some(place) => {
                part.copy_from_slice(&values[place * run_length + inside..][..part.len()]);
            }
        }
        at += part.len();
        to = rest;
    }
}
