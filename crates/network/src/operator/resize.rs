// SPDX-License-Identifier: MIT OR Apache-2.0
//! Resizing of features to another height and width.

use super::{
    Operator, OperatorJob, feature_size, moved_encoding, only_input, wrong_element_message,
};
use crate::element::{ElementType, Encoding, with_element_type};
use crate::mask::Mask;
use crate::tensor::TensorForm;
use crate::values::TensorNumber;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ResizeKind {
    Nearest(NearestRounding),
    Linear,
    /// Interpolation of four inputs along each axis. An input beyond the border is replaced by the
    /// nearest existing one, or does not count if `is_inside_only`.
    Cubic {
        a: f32,
        is_inside_only: bool,
    },
}

/// The rounding of a coordinate to an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NearestRounding {
    RoundPreferFloor,
    RoundPreferCeil,
    Floor,
    Ceil,
    /// Rounds down if the output is larger, and up if it is smaller, as before version 11 of the
    /// operators.
    Simple,
}

/// The mapping of output coordinates to input coordinates, with the names of ONNX.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ResizeCoordinates {
    HalfPixel,
    PytorchHalfPixel,
    AlignCorners,
    Asymmetric,
}

#[derive(Clone, Debug)]
pub(crate) struct Resize {
    pub(crate) kind: ResizeKind,
    pub(crate) coordinates: ResizeCoordinates,
    pub(crate) size: ResizeSize,
}

/// The rows and columns of the output, either as scales or as lengths.
#[derive(Clone, Debug)]
pub(crate) enum ResizeSize {
    Scales([f32; 2]),
    Sizes([usize; 2]),
}

/// The inputs of an output along one axis, up to four, with their weights. The weights of a single
/// input are 0 and not used. With two inputs, the third and the fourth weight are 0.
#[derive(Clone, Copy, Debug)]
struct AxisTaps {
    at: [usize; 4],
    weights: [f32; 4],
}

impl AxisTaps {
    /// One input with its index, without weights.
    fn single(at: usize) -> Self {
        Self { at: [at; 4], weights: [0.0; 4] }
    }

    /// Two inputs, with `share` as the weight of the second.
    fn pair(first: usize, second: usize, share: f32) -> Self {
        Self { at: [first, second, first, second], weights: [1.0 - share, share, 0.0, 0.0] }
    }

    fn range(&self) -> (usize, usize) {
        let [a, b, c, d] = self.at;
        (a.min(b).min(c).min(d), a.max(b).max(c).max(d))
    }
}

/// Returns the weights of four neighbors in cubic convolution interpolation (R. Keys, 1981). The
/// coordinate lies behind the second neighbor, at the distance `fraction`.
fn cubic_weights(a: f32, fraction: f32) -> [f32; 4] {
    let near = |distance: f32| ((a + 2.0) * distance - (a + 3.0)) * distance * distance + 1.0;
    let far = |distance: f32| ((a * distance - 5.0 * a) * distance + 8.0 * a) * distance - 4.0 * a;
    [far(fraction + 1.0), near(fraction), near(1.0 - fraction), far(2.0 - fraction)]
}

impl Resize {
    fn output_length(&self, axis: usize, inputs: usize) -> usize {
        match self.size {
            ResizeSize::Sizes(sizes) => sizes[axis],
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "the definition of ONNX"
            )]
            ResizeSize::Scales(scales) => (inputs as f32 * scales[axis]).floor() as usize,
        }
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "coordinates are below 2^24"
    )]
    fn taps(&self, axis: usize, inputs: usize, outputs: usize) -> Vec<AxisTaps> {
        let scale = match self.size {
            ResizeSize::Scales(scales) => scales[axis],
            ResizeSize::Sizes(_) => outputs as f32 / inputs as f32,
        };
        let last = inputs - 1;
        let tap = |output: usize| {
            let at = output as f32;
            let at = match self.coordinates {
                ResizeCoordinates::PytorchHalfPixel if outputs == 1 => 0.0,
                ResizeCoordinates::HalfPixel | ResizeCoordinates::PytorchHalfPixel => {
                    (at + 0.5) / scale - 0.5
                }
                ResizeCoordinates::AlignCorners if outputs == 1 => 0.0,
                ResizeCoordinates::AlignCorners => at * last as f32 / (outputs - 1) as f32,
                ResizeCoordinates::Asymmetric => at / scale,
            };
            match self.kind {
                ResizeKind::Nearest(nearest) => {
                    let whole = match nearest {
                        NearestRounding::RoundPreferFloor => (at - 0.5).ceil(),
                        NearestRounding::RoundPreferCeil => (at + 0.5).floor(),
                        NearestRounding::Floor => at.floor(),
                        NearestRounding::Ceil => at.ceil(),
                        NearestRounding::Simple if scale < 1.0 => at.ceil(),
                        NearestRounding::Simple => at.floor(),
                    };
                    AxisTaps::single((whole.max(0.0) as usize).min(last))
                }
                ResizeKind::Linear => {
                    let at = at.clamp(0.0, last as f32);
                    let first = at.floor() as usize;
                    AxisTaps::pair(first, (first + 1).min(last), at - at.floor())
                }
                ResizeKind::Cubic { a, is_inside_only } => {
                    let first = at.floor() - 1.0;
                    let positions = [0.0, 1.0, 2.0, 3.0].map(|tap| first + tap);
                    let mut weights = cubic_weights(a, at - at.floor());
                    if is_inside_only {
                        for (weight, position) in weights.iter_mut().zip(positions) {
                            *weight =
                                if (0.0..=last as f32).contains(&position) { *weight } else { 0.0 };
                        }
                        let sum: f32 = weights.iter().sum();
                        weights = weights.map(|weight| weight / sum);
                    }
                    let at = positions.map(|position| (position.max(0.0) as usize).min(last));
                    AxisTaps { at, weights }
                }
            }
        };
        (0..outputs).map(tap).collect()
    }
}

impl Operator for Resize {
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let [channels, height, width] = feature_size(only_input(inputs)?)?;
        let (height, width) = (self.output_length(0, height), self.output_length(1, width));
        if height == 0 || width == 0 {
            return Err("its output is empty".to_owned());
        }
        Ok(TensorForm::features(vec![1, channels, height, width]))
    }

    fn encoding(&self, inputs: &[Encoding]) -> Result<Encoding, String> {
        match (self.kind, moved_encoding(inputs)?) {
            (ResizeKind::Linear | ResizeKind::Cubic { .. }, Encoding { element, .. })
                if element != ElementType::F32 =>
            {
                Err(wrong_element_message(ElementType::F32, element))
            }
            (ResizeKind::Nearest(_) | ResizeKind::Linear | ResizeKind::Cubic { .. }, encoding) => {
                Ok(encoding)
            }
        }
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], output: &TensorForm) -> Mask {
        let (form, mask) = inputs[0];
        let range = |taps: Vec<AxisTaps>| -> Vec<(usize, usize)> {
            taps.iter().map(AxisTaps::range).collect()
        };
        let rows = range(self.taps(0, form.height(), output.height()));
        let columns = range(self.taps(1, form.width(), output.width()));
        mask.outputs_of_ranges(&rows, &columns)
    }

    fn takes_features(&self) -> bool {
        true
    }

    fn compute(&self, job: OperatorJob<'_>) {
        match self.kind {
            ResizeKind::Nearest(_) => with_element_type!(job.form.encoding().element, T => {
                self.fill(job, |plane: &[T], width, row, column| plane[row.at[0] * width + column.at[0]]);
            }),
            ResizeKind::Linear => self.fill(job, |plane: &[f32], width, row, column| {
                let line = |y: usize| {
                    let [left, right] = [0, 1].map(|tap| plane[y * width + column.at[tap]]);
                    interpolated(left, right, column.weights[1])
                };
                interpolated(line(row.at[0]), line(row.at[1]), row.weights[1])
            }),
            ResizeKind::Cubic { .. } => self.fill(job, |plane: &[f32], width, row, column| {
                weighted_sum(row, |y| weighted_sum(column, |x| plane[y * width + x]))
            }),
        }
    }
}

/// Returns the weighted sum of inputs.
#[inline(always)]
fn weighted_sum(taps: &AxisTaps, value: impl Fn(usize) -> f32) -> f32 {
    taps.at.iter().zip(taps.weights).map(|(&at, weight)| weight * value(at)).sum()
}

impl Resize {
    /// Fills every output. `compute_value` takes the plane of the channel, the length of its rows,
    /// and the taps of the row and of the column.
    fn fill<T: TensorNumber>(
        &self,
        job: OperatorJob<'_>,
        compute_value: impl Fn(&[T], usize, &AxisTaps, &AxisTaps) -> T + Sync,
    ) {
        let (inputs, form) = (job.inputs, job.form);
        let (height, width) = (inputs[0].form().height(), inputs[0].form().width());
        let rows = self.taps(0, height, form.height());
        let columns = self.taps(1, width, form.width());
        job.fill(|run, to| {
            let (mut start, mut to) = (run.start, to);
            while !to.is_empty() {
                let (channel, y, x) = form.coordinates(start);
                let plane = &inputs[0].values()[channel * height * width..][..height * width];
                let (line, rest) = to.split_at_mut(to.len().min(form.width() - x));
                start += line.len();
                to = rest;
                for (to, column) in line.iter_mut().zip(&columns[x..]) {
                    *to = compute_value(plane, width, &rows[y], column);
                }
            }
        });
    }
}

/// Interpolates between two values. If the share of the second is 0, the result is the first, even
/// if the second is infinite or NaN.
#[inline(always)]
fn interpolated(first: f32, second: f32, share: f32) -> f32 {
    if share == 0.0 { first } else { first + (second - first) * share }
}
