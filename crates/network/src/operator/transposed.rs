// SPDX-License-Identifier: MIT OR Apache-2.0
//! Transposed convolution: every input is spread over a window of outputs.
//!
//! Outputs whose positions have the same remainder by the stride see the same taps. Each such phase
//! is a convolution over the unchanged input, and its products are summed in the order of that
//! convolution.

use super::{Activation, Job, Operator, Products, features, only, values_of};
use crate::form::Form;
use crate::kernel::{self, Blocking, Outputs, Picture, Weights, chunks};
use crate::mask::{Mask, Window};
use crate::threads;
use foveate_lanes::Level;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The window of a transposed convolution along one axis: input `i` reaches the outputs
/// `i * stride - before + k * dilation`, for `k` from 0 to `kernel - 1`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach {
    pub(crate) kernel: usize,
    pub(crate) stride: usize,
    pub(crate) dilation: usize,
    /// The number of outputs that are cut off at the front.
    pub(crate) before: usize,
    pub(crate) outputs: usize,
}

/// The outputs with one remainder by the stride along an axis.
#[derive(Clone, Copy, Debug)]
struct Phase {
    remainder: usize,
    window: Window,
    /// The tap that meets the first input.
    last: usize,
    /// The distance from a tap to the tap that meets the next input.
    step: usize,
}

impl Reach {
    /// Returns the phases that have taps.
    fn phases(self) -> Vec<Phase> {
        let mut taps: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for tap in 0..self.kernel {
            taps.entry(tap * self.dilation % self.stride).or_default().push(tap);
        }
        let phase = |(remainder, taps): (usize, Vec<usize>)| {
            let last = taps[taps.len() - 1];
            let step = if let &[first, second, ..] = taps.as_slice() { second - first } else { 1 };
            let window = Window {
                kernel: taps.len(),
                stride: 1,
                dilation: (step * self.dilation / self.stride).max(1),
                before: (last * self.dilation - remainder) / self.stride,
                after: 0,
            };
            Phase { remainder, window, last, step }
        };
        taps.into_iter().map(phase).collect()
    }

    /// Returns the range of inputs that each output sees, as the first and the last input.
    fn seen(self, inputs: usize) -> Vec<(usize, usize)> {
        let Self { kernel, stride, dilation, before, outputs } = self;
        let range = |output: usize| {
            let at = output + before;
            let first = at.saturating_sub((kernel - 1) * dilation).div_ceil(stride);
            match (at / stride).min(inputs - 1) {
                last if last < first => (1, 0),
                last => (first, last),
            }
        };
        (0..outputs).map(range).collect()
    }

    /// Returns the range of outputs that each input reaches, as the first and the last output.
    fn reached(self, inputs: usize) -> Vec<(usize, usize)> {
        let range = |input: usize| {
            let first = (input * self.stride).saturating_sub(self.before);
            let end = input * self.stride + (self.kernel - 1) * self.dilation + 1;
            let end = end.saturating_sub(self.before).min(self.outputs);
            if end > first { (first, end - 1) } else { (1, 0) }
        };
        (0..inputs).map(range).collect()
    }

    /// Returns the number of outputs of a phase, including those that are cut off at the front.
    fn count(self, phase: Phase) -> usize {
        (self.outputs + self.before).saturating_sub(phase.remainder).div_ceil(self.stride)
    }

    /// Returns the index of an output of a phase among all outputs, unless it is cut off.
    fn output(self, phase: Phase, at: usize) -> Option<usize> {
        (at * self.stride + phase.remainder).checked_sub(self.before)
    }
}

#[derive(Clone, Debug)]
pub(crate) struct TransposedConv {
    rows: Reach,
    columns: Reach,
    groups: usize,
    channels: usize,
    inputs: usize,
    level: Level,
    bias: Vec<f32>,
    /// The phases along rows and columns, with the packed weights of each group.
    phases: Vec<([Phase; 2], Vec<Weights>)>,
    finish: Activation,
    weight_bytes: u64,
}

impl TransposedConv {
    /// Returns the transposed convolution with weights of the shape
    /// `[inputs, channels per group, rows, columns]`.
    pub(crate) fn new(
        shape: &[usize],
        weights: &[f32],
        bias: Option<&[f32]>,
        [rows, columns]: [Reach; 2],
        groups: usize,
        level: Level,
    ) -> Result<Self, String> {
        let &[inputs, own, height, width] = shape else {
            return Err(format!("its weights have {} axes, not 4", shape.len()));
        };
        if shape.contains(&0) || inputs % groups != 0 {
            return Err(format!("its weights {shape:?} do not fit {groups} groups"));
        }
        let channels = own.checked_mul(groups).ok_or("it has too many channels")?;
        let bias = bias.map_or_else(|| vec![0.0; channels], <[f32]>::to_vec);
        if bias.len() != channels {
            return Err(format!("its bias has {} values, not {channels}", bias.len()));
        }
        let of_group = inputs / groups;
        let pack = |group: usize, [y, x]: [Phase; 2]| {
            let mut packed = Vec::new();
            for (channel, input) in
                (0..own).flat_map(|channel| (0..of_group).map(move |input| (channel, input)))
            {
                let plane = ((group * of_group + input) * own + channel) * height * width;
                for tap_y in (0..y.window.kernel).map(|tap| y.last - tap * y.step) {
                    let taps = (0..x.window.kernel).map(|tap| x.last - tap * x.step);
                    packed.extend(taps.map(|tap_x| weights[plane + tap_y * width + tap_x]));
                }
            }
            let depth = of_group * y.window.kernel * x.window.kernel;
            Weights::new(&packed, depth, &bias[group * own..][..own], Blocking::of(level))
        };
        let (of_rows, of_columns) = (rows.phases(), columns.phases());
        let pairs = of_rows.iter().flat_map(|&y| of_columns.iter().map(move |&x| [y, x]));
        let phases = pairs
            .map(|pair| (pair, (0..groups).map(|group| pack(group, pair)).collect()))
            .collect();
        let weight_bytes = 4 * (weights.len() + bias.len()) as u64;
        let finish = Activation::Identity;
        Ok(Self {
            rows,
            columns,
            groups,
            channels,
            inputs,
            level,
            bias,
            phases,
            finish,
            weight_bytes,
        })
    }

    /// Computes the needed outputs of a phase.
    fn convolve(&self, job: &mut Job<'_>, [y, x]: [Phase; 2], weights: &[Weights]) {
        let (height, width) = (self.rows.count(y), self.columns.count(x));
        let output = |row: usize, column: usize| {
            let (row, column) = (self.rows.output(y, row)?, self.columns.output(x, column)?);
            job.at.contains(column, row).then_some((row, column))
        };
        let at = Mask::from_fn(height, width, |column, row| output(row, column).is_some());
        let chunks = chunks(&at);
        if chunks.is_empty() {
            return;
        }
        let input = job.inputs[0].form();
        let own = self.channels / self.groups;
        let form = Form::features(vec![1, own, height, width]);
        let seen = self.inputs / self.groups * input.places();
        let mut planes = vec![0.0; form.elements()];
        for (group, weights) in weights.iter().enumerate() {
            let picture = Picture {
                values: &job.inputs[0].values()[group * seen..][..seen],
                height: input.height(),
                width: input.width(),
                rows: y.window,
                columns: x.window,
                padding: 0.0,
            };
            let part = |(chunks, outputs): (&[kernel::Chunk], Outputs<'_>)| {
                let finish = |x| self.finish.of(x);
                kernel::convolve(self.level, &picture, weights, chunks, outputs, finish);
            };
            let parts = kernel::parts(weights.blocks(), &chunks, &mut planes, [height, width]);
            threads::each_part(parts, &part);
            let to = &mut values_of::<f32>(job.output, job.form)[group * own * job.form.places()..];
            for (plane, to) in planes.chunks(form.places()).zip(to.chunks_mut(job.form.places())) {
                for row in 0..height {
                    for (column, count) in at.runs(row) {
                        for column in column..column + count {
                            let (to_row, to_column) =
                                output(row, column).expect("the mask holds those that are wanted");
                            to[to_row * job.form.width() + to_column] = plane[row * width + column];
                        }
                    }
                }
            }
        }
    }
}

impl Operator for TransposedConv {
    fn form(&self, inputs: &[&Form]) -> Result<Form, String> {
        let [channels, ..] = features(only(inputs)?)?;
        if channels != self.inputs {
            return Err(format!("it takes {} channels, but its input has {channels}", self.inputs));
        }
        Ok(Form::features(vec![1, self.channels, self.rows.outputs, self.columns.outputs]))
    }

    fn spread(&self, inputs: &[(&Form, &Mask)], _output: &Form) -> Mask {
        let (form, mask) = inputs[0];
        mask.between(&self.rows.seen(form.height()), &self.columns.seen(form.width()))
    }

    fn compute(&self, mut job: Job<'_>) {
        // Outputs that no input reaches are set to their bias.
        if self.phases.len() < self.rows.stride * self.columns.stride {
            let places = job.form.places();
            let planes = values_of::<f32>(job.output, job.form).chunks_mut(places);
            let ranges = job.at.ranges();
            for (plane, &bias) in planes.zip(&self.bias) {
                ranges.iter().for_each(|run| plane[run.clone()].fill(self.finish.of(bias)));
            }
        }
        for (phase, weights) in &self.phases {
            self.convolve(&mut job, *phase, weights);
        }
    }

    fn products(&self) -> Products {
        let taps = |reach: Reach| reach.kernel.div_ceil(reach.stride);
        let inputs = self.inputs / self.groups * taps(self.rows) * taps(self.columns);
        Products::Transposed { inputs }
    }

    fn takes_features(&self) -> bool {
        true
    }

    fn seen(&self, at: &Mask, input: &Form) -> Mask {
        at.between(&self.rows.reached(input.height()), &self.columns.reached(input.width()))
    }

    fn finished(&self, finish: Activation) -> Option<Arc<dyn Operator>> {
        let is_free = self.finish == Activation::Identity;
        is_free.then(|| Arc::new(Self { finish, ..self.clone() }) as Arc<dyn Operator>)
    }

    fn weight_bytes(&self) -> u64 {
        self.weight_bytes
    }
}
