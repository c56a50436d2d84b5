// SPDX-License-Identifier: MIT OR Apache-2.0
//! The largest value or the mean of a window.

use super::conv::outputs;
use super::{Job, Operator, features, only};
use crate::form::Form;
use crate::mask::{Mask, Window};
use rayon::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PoolKind {
    Max,
    /// Whether padding counts as values of 0.
    Average {
        with_padding: bool,
    },
}

#[derive(Clone, Debug)]
pub(crate) struct Pool {
    pub(crate) kind: PoolKind,
    pub(crate) rows: Window,
    pub(crate) columns: Window,
    /// Whether a window that only begins inside the input counts.
    pub(crate) ceil: bool,
}

impl Pool {
    fn outputs(&self, window: Window, inputs: usize) -> Result<usize, String> {
        let whole = outputs(window, inputs)?;
        let used = (whole - 1) * window.stride + window.span();
        let begins_inside = whole * window.stride < inputs + window.before;
        Ok(if self.ceil && used < inputs + window.before + window.after && begins_inside {
            whole + 1
        } else {
            whole
        })
    }

    /// One output from the values of its window that are not padding, row by row.
    fn of(&self, plane: &[f32], [height, width]: [usize; 2], x: usize, y: usize) -> f32 {
        let inside = (0..self.rows.kernel)
            .filter_map(|tap| self.rows.input(y, tap, height))
            .flat_map(|row| {
                (0..self.columns.kernel)
                    .filter_map(move |tap| self.columns.input(x, tap, width))
                    .map(move |x| plane[row * width + x])
            });
        match self.kind {
            // NaN is larger than anything.
            PoolKind::Max => inside.fold(f32::NEG_INFINITY, |most, value| {
                if value > most || value.is_nan() { value } else { most }
            }),
            PoolKind::Average { with_padding } => {
                let (sum, count) =
                    inside.fold((0.0, 0u16), |(sum, count), value| (sum + value, count + 1));
                let count = if with_padding { self.counted(x, y, [height, width]) } else { count };
                sum / f32::from(count)
            }
        }
    }

    /// Values and padding of a window; what lies beyond the padding, which a last window may have, does not count.
    fn counted(&self, x: usize, y: usize, [height, width]: [usize; 2]) -> u16 {
        let along = |window: Window, at: usize, inputs: usize| {
            let end = inputs + window.before + window.after;
            (0..window.kernel)
                .filter(|tap| at * window.stride + tap * window.dilation < end)
                .count()
        };
        let counted = along(self.rows, y, height) * along(self.columns, x, width);
        u16::try_from(counted).expect("a window has less than 2^16 values")
    }
}

impl Operator for Pool {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let [channels, height, width] = features(only(inputs)?)?;
        if self.rows.kernel * self.columns.kernel > usize::from(u16::MAX) {
            return Err(format!(
                "its window of {}x{} is larger than is known",
                self.rows.kernel, self.columns.kernel
            ));
        }
        let (height, width) =
            (self.outputs(self.rows, height)?, self.outputs(self.columns, width)?);
        Ok(Form::features(vec![1, channels, height, width]))
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], output: &Form) -> Mask {
        inputs[0].1.through(self.rows, self.columns, output.height(), output.width())
    }

    fn compute(&self, job: Job<'_>) {
        let Job { inputs, output, at, .. } = job;
        let size = [inputs[0].form().height(), inputs[0].form().width()];
        let (places, width) = (output.form().places(), output.form().width());
        let planes = inputs[0].values().par_chunks(size[0] * size[1]);
        output.values_mut().par_chunks_mut(places).zip(planes).for_each(|(output, plane)| {
            for y in 0..at.height() {
                for (start, length) in at.runs(y) {
                    for x in start..start + length {
                        output[y * width + x] = self.of(plane, size, x, y);
                    }
                }
            }
        });
    }
}
