// SPDX-License-Identifier: MIT OR Apache-2.0
//! Pooling: the largest value or the mean of a window.

use super::conv::output_length;
use super::{
    Operator, OperatorJob, feature_size, moved_encoding, only_input, output_values,
    wrong_element_message,
};
use crate::element::{ElementType, Encoding, with_element_type};
use crate::mask::{AxisWindow, Mask};
use crate::tensor::TensorForm;
use crate::threads;
use crate::values::TensorNumber;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PoolKind {
    Max,
    /// The mean of a window; `with_padding` says that padding counts as values of 0.
    Average {
        with_padding: bool,
    },
}

#[derive(Clone, Debug)]
pub(crate) struct Pool {
    pub(crate) kind: PoolKind,
    pub(crate) rows: AxisWindow,
    pub(crate) columns: AxisWindow,
    /// True if the last window may reach beyond the padding behind the input. It must begin inside
    /// the input or in the padding before it.
    pub(crate) rounds_up: bool,
}

impl Pool {
    fn output_length(&self, window: AxisWindow, inputs: usize) -> Result<usize, String> {
        let whole = output_length(window, inputs)?;
        let used = (whole - 1) * window.stride + window.span();
        let begins_inside = whole * window.stride < inputs + window.padding_before;
        Ok(
            if self.rounds_up
                && used < inputs + window.padding_before + window.padding_after
                && begins_inside
            {
                whole + 1
            } else {
                whole
            },
        )
    }

    /// Calls `add` for every output of `x..x + run.len()` in row `y` with every input that it sees,
    /// tap by tap in row-major order.
    #[inline(always)]
    pub(super) fn accumulate<T: TensorNumber, S>(
        &self,
        plane: &[T],
        [height, width]: [usize; 2],
        (x, y): (usize, usize),
        run: &mut [S],
        add: impl Fn(&mut S, T),
    ) {
        for row in (0..self.rows.kernel).filter_map(|tap| self.rows.input_index(y, tap, height)) {
            let line = &plane[row * width..][..width];
            for tap in 0..self.columns.kernel {
                // The outputs for which the input of this tap exists are neighbors.
                let inside = |at: &usize| self.columns.input_index(x + at, tap, width).is_some();
                let Some(first) = (0..run.len()).find(inside) else { continue };
                let input = self.columns.input_index(x + first, tap, width).expect("it exists");
                let (run, line) = (run[first..].iter_mut(), &line[input..]);
                match self.columns.stride {
                    // Loops over neighbors become vector instructions.
                    1 => run.zip(line).for_each(|(to, &value)| add(to, value)),
                    stride => {
                        let inputs = line.iter().step_by(stride);
                        run.zip(inputs).for_each(|(to, &value)| add(to, value));
                    }
                }
            }
        }
    }

    /// Returns, for each output from position `x` of row `y` on, the number of values that count
    /// for its mean.
    pub(super) fn window_counts(
        &self,
        [height, width]: [usize; 2],
        (x, y): (usize, usize),
        with_padding: bool,
    ) -> impl Iterator<Item = u16> {
        let rows = counted_taps(self.rows, y, height, with_padding);
        (x..).map(move |at| rows * counted_taps(self.columns, at, width, with_padding))
    }

    /// Computes the largest values of windows in two passes: first the largest value of each row of
    /// a window, then the largest of these. The result is the first of equal values, or the last
    /// NaN, as if the whole window was read in order.
    fn compute_max<T: TensorNumber>(&self, job: OperatorJob<'_>) {
        let OperatorJob { inputs, form, output, positions: at } = job;
        let (height, width) = (inputs[0].form().height(), inputs[0].form().width());
        let along_rows = Self { rows: AxisWindow::SAME, ..self.clone() };
        let across_rows = Self { columns: AxisWindow::SAME, ..self.clone() };
        let needed_rows = at.inputs_through(self.rows, AxisWindow::SAME, height, form.width());
        let pass = |pool: &Self, from: &[T], size, at: &Mask, to: &mut [T]| {
            for_each_plane_run(at, to, |place, run| {
                run.fill(T::LOWEST);
                pool.accumulate(from, size, place, run, |largest, value| {
                    *largest = if value.is_greater(*largest) { value } else { *largest };
                });
            });
        };
        let planes = inputs[0].values::<T>();
        let channel = |rows: &mut Vec<T>, number: usize, output: &mut [T]| {
            let plane = &planes[number * height * width..][..height * width];
            rows.resize(height * form.width(), T::LOWEST);
            pass(&along_rows, plane, [height, width], &needed_rows, rows);
            pass(&across_rows, rows, [height, form.width()], at, output);
        };
        threads::for_each_chunk_with_scratch(
            output_values(output, form),
            form.position_count(),
            &channel,
        );
    }

    fn compute_average(&self, job: OperatorJob<'_>, with_padding: bool) {
        self.fill_runs(job, |plane: &[f32], size, place, run: &mut [f32]| {
            run.fill(0.0);
            self.accumulate(plane, size, place, run, |sum, value: f32| *sum += value);
            for (sum, count) in run.iter_mut().zip(self.window_counts(size, place, with_padding)) {
                *sum /= f32::from(count);
            }
        });
    }

    /// Fills every run of outputs of every channel from the inputs of the channel. Threads share
    /// the channels.
    pub(super) fn fill_runs<T: TensorNumber, Y: TensorNumber>(
        &self,
        job: OperatorJob<'_>,
        fill: impl Fn(&[T], [usize; 2], (usize, usize), &mut [Y]) + Sync,
    ) {
        let OperatorJob { inputs, form, output, positions: at } = job;
        let size = [inputs[0].form().height(), inputs[0].form().width()];
        let planes = inputs[0].values::<T>();
        threads::for_each_chunk(
            output_values(output, form),
            form.position_count(),
            &|number, output| {
                let plane = &planes[number * size[0] * size[1]..][..size[0] * size[1]];
                for_each_plane_run(at, output, |place, run| fill(plane, size, place, run));
            },
        );
    }
}

/// Calls `fill` with the position and the values of every run of positions of a channel.
fn for_each_plane_run<T>(
    at: &Mask,
    plane: &mut [T],
    mut fill: impl FnMut((usize, usize), &mut [T]),
) {
    for y in 0..at.height() {
        for (x, length) in at.runs(y) {
            fill((x, y), &mut plane[y * at.width() + x..][..length]);
        }
    }
}

/// Returns the number of taps of a window that count: those inside the input and, if wanted, those
/// in its padding. Taps beyond the padding, which the last window may have, do not count.
fn counted_taps(window: AxisWindow, at: usize, inputs: usize, with_padding: bool) -> u16 {
    let end = inputs + window.padding_before + window.padding_after;
    let counts = |tap: &usize| match with_padding {
        true => at * window.stride + tap * window.dilation < end,
        false => window.input_index(at, *tap, inputs).is_some(),
    };
    u16::try_from((0..window.kernel).filter(counts).count())
        .expect("a window has less than 2^16 values")
}

impl Operator for Pool {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let [channels, height, width] = feature_size(only_input(inputs)?)?;
        if self.rows.kernel * self.columns.kernel > usize::from(u16::MAX) {
            return Err(format!(
                "its window of {}x{} is too large; at most 65535 positions are supported",
                self.rows.kernel, self.columns.kernel
            ));
        }
        let (height, width) =
            (self.output_length(self.rows, height)?, self.output_length(self.columns, width)?);
        Ok(TensorForm::features(vec![1, channels, height, width]))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match (self.kind, moved_encoding(inputs)?) {
            (PoolKind::Average { .. }, Encoding { element, .. }) if element != ElementType::F32 => {
                Err(wrong_element_message(ElementType::F32, element))
            }
            (_, encoding) => Ok(encoding),
        }
    }

    fn axis_windows(&self) -> Option<[AxisWindow; 2]> {
        Some([self.rows, self.columns])
    }

    fn compute(&self, job: OperatorJob<'_>) {
        match self.kind {
            PoolKind::Max => {
                with_element_type!(job.form.encoding().element, T => self.compute_max::<T>(job));
            }
            PoolKind::Average { with_padding } => self.compute_average(job, with_padding),
        }
    }
}
