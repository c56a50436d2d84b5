// SPDX-License-Identifier: MIT OR Apache-2.0
//! A part of a tensor.

use super::{Job, Operator, moved, only};
use crate::element::{Encoding, typed};
use crate::form::Form;
use crate::mask::Mask;

/// A part of some axes, and all of the others.
#[derive(Clone, Debug)]
pub(crate) struct Slice {
    pub(crate) cuts: Vec<Cut>,
}

/// Every so many elements of an axis, from a first one to before a last one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    pub(crate) axis: i64,
    /// Negative from the end on, and cut off where the axis ends.
    pub(crate) start: i64,
    pub(crate) end: i64,
    pub(crate) step: usize,
}

/// The elements of an axis that are taken.
#[derive(Clone, Copy, Debug)]
struct Taken {
    start: usize,
    step: usize,
    count: usize,
}

impl Taken {
    fn all(count: usize) -> Self {
        Self { start: 0, step: 1, count }
    }

    /// What each element sees.
    fn sources(self) -> Vec<(usize, usize)> {
        (0..self.count).map(|at| self.start + at * self.step).map(|at| (at, at)).collect()
    }
}

impl Cut {
    /// What it takes of so many elements.
    fn of(&self, count: usize) -> Result<Taken, String> {
        let length = i64::try_from(count).map_err(|_| "an axis is too long")?;
        let place =
            |at: i64| if at < 0 { at.saturating_add(length).max(0) } else { at.min(length) };
        let (start, end) = (place(self.start), place(self.end));
        match usize::try_from(end - start).map(|count| count.div_ceil(self.step)) {
            Ok(count) if count > 0 => {
                let start = usize::try_from(start).expect("not negative");
                Ok(Taken { start, step: self.step, count })
            }
            _ => Err(format!("{}..{} of {length} elements is empty", self.start, self.end)),
        }
    }
}

impl Slice {
    /// What is taken of every axis.
    fn taken(&self, form: &Form) -> Result<Vec<Taken>, String> {
        let mut cuts = vec![None; form.shape().len()];
        for cut in &self.cuts {
            let axis = form.axis(cut.axis)?;
            if cuts[axis].replace(cut).is_some() {
                return Err(format!("its axis {axis} is cut twice"));
            }
        }
        let of = |(cut, &count): (&Option<&Cut>, _)| {
            cut.map_or(Ok(Taken::all(count)), |cut| cut.of(count))
        };
        cuts.iter().zip(form.shape()).map(of).collect()
    }
}

impl Operator for Slice {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let input = only(inputs)?;
        let shape = self.taken(input)?.iter().map(|taken| taken.count).collect();
        Ok(Form::at(shape, input.axes()))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        moved(inputs)
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], _output: &Form) -> Mask {
        let (form, mask) = inputs[0];
        let taken = self.taken(form).expect("the form has them");
        match &taken[form.axes()] {
            [rows, columns] => mask.between(&rows.sources(), &columns.sources()),
            [columns] => mask.between(&Taken::all(1).sources(), &columns.sources()),
            _ => mask.clone(),
        }
    }

    fn compute(&self, job: Job<'_>) {
        let (inputs, form) = (job.inputs, job.form);
        let input = inputs[0].form();
        let taken = self.taken(input).expect("the form has them");
        let steps = input.steps();
        let first: usize = taken.iter().zip(&steps).map(|(taken, step)| taken.start * step).sum();
        let steps: Vec<usize> =
            taken.iter().zip(&steps).map(|(taken, step)| taken.step * step).collect();
        typed!(form.encoding().element, T => job.fill::<T>(|run, to| {
            for (place, to) in run.zip(to) {
                *to = inputs[0].values()[first + form.offset(place, &steps)];
            }
        }));
    }
}
