// SPDX-License-Identifier: MIT OR Apache-2.0
//! Transposed convolution: every input is spread over a window of outputs.
//!
//! Outputs whose positions have the same remainder by the stride see the same taps. Each such phase
//! is a convolution over the unchanged input, and its products are summed in the order of that
//! convolution.

use super::{Operator, OperatorJob, ProductKind, feature_size, only_input, output_values};
use crate::activation::Activation;
use crate::kernel::{self, BlockSizes, ConvInput, ConvOutputs, PackedWeights, chunks_of_mask};
use crate::mask::{AxisWindow, Mask};
use crate::tensor::TensorForm;
use crate::threads;
use foveate_pixels::vectors::InstructionSet;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The window of a transposed convolution along one axis: input `i` reaches the outputs
/// `i * stride - before + k * dilation`, for `k` from 0 to `kernel - 1`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TransposedWindow {
    pub(crate) kernel: usize,
    pub(crate) stride: usize,
    pub(crate) dilation: usize,
    /// The number of outputs that are cut off at the front.
    pub(crate) before: usize,
    pub(crate) outputs: usize,
}

/// The outputs with one remainder by the stride along an axis.
#[derive(Clone, Copy, Debug)]
struct OutputPhase {
    remainder: usize,
    window: AxisWindow,
    /// The tap that meets the first input.
    last_tap: usize,
    /// The distance from a tap to the tap that meets the next input.
    tap_step: usize,
}

impl TransposedWindow {
    /// Returns the phases that have taps.
    fn phases(self) -> Vec<OutputPhase> {
        let mut taps: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for tap in 0..self.kernel {
            taps.entry(tap * self.dilation % self.stride).or_default().push(tap);
        }
        let phase = |(remainder, taps): (usize, Vec<usize>)| {
            let last = taps[taps.len() - 1];
            let step = if let &[first, second, ..] = taps.as_slice() { second - first } else { 1 };
            let window = AxisWindow {
                kernel: taps.len(),
                stride: 1,
                dilation: (step * self.dilation / self.stride).max(1),
                padding_before: (last * self.dilation - remainder) / self.stride,
                padding_after: 0,
            };
            OutputPhase { remainder, window, last_tap: last, tap_step: step }
        };
        taps.into_iter().map(phase).collect()
    }

    /// Returns the range of inputs that each output sees, as the first and the last input.
    fn inputs_of_outputs(self, inputs: usize) -> Vec<(usize, usize)> {
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
    fn outputs_of_inputs(self, inputs: usize) -> Vec<(usize, usize)> {
        let range = |input: usize| {
            let first = (input * self.stride).saturating_sub(self.before);
            let end = input * self.stride + (self.kernel - 1) * self.dilation + 1;
            let end = end.saturating_sub(self.before).min(self.outputs);
            if end > first { (first, end - 1) } else { (1, 0) }
        };
        (0..inputs).map(range).collect()
    }

    /// Returns the number of outputs of a phase, including those that are cut off at the front.
    fn phase_length(self, phase: OutputPhase) -> usize {
        (self.outputs + self.before).saturating_sub(phase.remainder).div_ceil(self.stride)
    }

    /// Returns the index of an output of a phase among all outputs, unless it is cut off.
    fn output_index(self, phase: OutputPhase, at: usize) -> Option<usize> {
        (at * self.stride + phase.remainder).checked_sub(self.before)
    }
}

#[derive(Clone, Debug)]
pub(crate) struct TransposedConv {
    rows: TransposedWindow,
    columns: TransposedWindow,
    groups: usize,
    channels: usize,
    inputs: usize,
    level: InstructionSet,
    bias: Vec<f32>,
    /// The phases along rows and columns, with the packed weights of each group.
    phases: Vec<([OutputPhase; 2], Vec<PackedWeights>)>,
    activation: Activation,
    weight_bytes: u64,
}

impl TransposedConv {
    /// Returns the transposed convolution with weights of the shape
    /// `[inputs, channels per group, rows, columns]`.
    pub(crate) fn new(
        shape: &[usize],
        weights: &[f32],
        bias: Option<&[f32]>,
        [rows, columns]: [TransposedWindow; 2],
        groups: usize,
        level: InstructionSet,
    ) -> Result<Self, String> {
        let &[inputs, channels_per_group, height, width] = shape else {
            return Err(format!("its weights have {} axes, not 4", shape.len()));
        };
        if shape.contains(&0) || inputs % groups != 0 {
            return Err(format!("its weights {shape:?} do not fit {groups} groups"));
        }
        let channels = channels_per_group.checked_mul(groups).ok_or("it has too many channels")?;
        let bias = bias.map_or_else(|| vec![0.0; channels], <[f32]>::to_vec);
        if bias.len() != channels {
            return Err(format!("its bias has {} values, not {channels}", bias.len()));
        }
        let inputs_per_group = inputs / groups;
        let pack = |group: usize, [y, x]: [OutputPhase; 2]| {
            let mut packed = Vec::new();
            for (channel, input) in (0..channels_per_group)
                .flat_map(|channel| (0..inputs_per_group).map(move |input| (channel, input)))
            {
                let plane = ((group * inputs_per_group + input) * channels_per_group + channel)
                    * height
                    * width;
                for tap_y in (0..y.window.kernel).map(|tap| y.last_tap - tap * y.tap_step) {
                    let taps = (0..x.window.kernel).map(|tap| x.last_tap - tap * x.tap_step);
                    packed.extend(taps.map(|tap_x| weights[plane + tap_y * width + tap_x]));
                }
            }
            let depth = inputs_per_group * y.window.kernel * x.window.kernel;
            PackedWeights::new(
                &packed,
                depth,
                &bias[group * channels_per_group..][..channels_per_group],
                BlockSizes::for_instruction_set(level),
            )
        };
        let (row_phases, column_phases) = (rows.phases(), columns.phases());
        let pairs = row_phases.iter().flat_map(|&y| column_phases.iter().map(move |&x| [y, x]));
        let phases = pairs
            .map(|pair| (pair, (0..groups).map(|group| pack(group, pair)).collect()))
            .collect();
        let weight_bytes = 4 * (weights.len() + bias.len()) as u64;
        let activation = Activation::Identity;
        Ok(Self {
            rows,
            columns,
            groups,
            channels,
            inputs,
            level,
            bias,
            phases,
            activation,
            weight_bytes,
        })
    }

    /// Computes the needed outputs of a phase.
    fn convolve(
        &self,
        job: &mut OperatorJob<'_>,
        [y, x]: [OutputPhase; 2],
        weights: &[PackedWeights],
    ) {
        let (height, width) = (self.rows.phase_length(y), self.columns.phase_length(x));
        let output = |row: usize, column: usize| {
            let (row, column) =
                (self.rows.output_index(y, row)?, self.columns.output_index(x, column)?);
            job.positions.contains(column, row).then_some((row, column))
        };
        let at = Mask::from_fn(height, width, |column, row| output(row, column).is_some());
        let chunks = chunks_of_mask(&at);
        if chunks.is_empty() {
            return;
        }
        let input = job.inputs[0].form();
        let channels_per_group = self.channels / self.groups;
        let form = TensorForm::features(vec![1, channels_per_group, height, width]);
        let values_per_group = self.inputs / self.groups * input.position_count();
        // The outputs of the phase are computed side by side in planes of their own. Then they are
        // copied to their positions among the outputs of the other phases.
        let mut planes = vec![0.0; form.element_count()];
        for (group, weights) in weights.iter().enumerate() {
            let picture = ConvInput {
                values: &job.inputs[0].values()[group * values_per_group..][..values_per_group],
                height: input.height(),
                width: input.width(),
                rows: y.window,
                columns: x.window,
                padding: 0.0,
            };
            let part = |(chunks, outputs): (&[kernel::PositionChunk], ConvOutputs<'_>)| {
                kernel::convolve(self.level, &picture, weights, chunks, outputs, self.activation);
            };
            let parts =
                kernel::thread_parts(weights.blocks(), &chunks, &mut planes, [height, width]);
            threads::for_each_part(parts, &part);
            let to = &mut output_values::<f32>(job.output, job.form)
                [group * channels_per_group * job.form.position_count()..];
            for (plane, to) in
                planes.chunks(form.position_count()).zip(to.chunks_mut(job.form.position_count()))
            {
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
    fn form(&self, inputs: &[&TensorForm]) -> Result<TensorForm, String> {
        let [channels, ..] = feature_size(only_input(inputs)?)?;
        if channels != self.inputs {
            return Err(format!("it takes {} channels, but its input has {channels}", self.inputs));
        }
        Ok(TensorForm::features(vec![1, self.channels, self.rows.outputs, self.columns.outputs]))
    }

    fn spread(&self, inputs: &[(&TensorForm, &Mask)], _output: &TensorForm) -> Mask {
        let (form, mask) = inputs[0];
        mask.outputs_of_ranges(
            &self.rows.inputs_of_outputs(form.height()),
            &self.columns.inputs_of_outputs(form.width()),
        )
    }

    fn compute(&self, mut job: OperatorJob<'_>) {
        // Outputs that no input reaches are set to their bias.
        if self.phases.len() < self.rows.stride * self.columns.stride {
            let places = job.form.position_count();
            let planes = output_values::<f32>(job.output, job.form).chunks_mut(places);
            let ranges = job.positions.memory_ranges();
            for (plane, &bias) in planes.zip(&self.bias) {
                ranges.iter().for_each(|run| plane[run.clone()].fill(self.activation.apply(bias)));
            }
        }
        for (phase, weights) in &self.phases {
            self.convolve(&mut job, *phase, weights);
        }
    }

    fn products(&self) -> ProductKind {
        let taps = |window: TransposedWindow| window.kernel.div_ceil(window.stride);
        let inputs = self.inputs / self.groups * taps(self.rows) * taps(self.columns);
        ProductKind::Transposed { inputs }
    }

    fn takes_features(&self) -> bool {
        true
    }

    fn needed_input(&self, at: &Mask, input: &TensorForm) -> Mask {
        at.outputs_of_ranges(
            &self.rows.outputs_of_inputs(input.height()),
            &self.columns.outputs_of_inputs(input.width()),
        )
    }

    fn with_activation(&self, activation: Activation) -> Option<Arc<dyn Operator>> {
        let is_free = self.activation == Activation::Identity;
        is_free.then(|| Arc::new(Self { activation, ..self.clone() }) as Arc<dyn Operator>)
    }

    fn weight_bytes(&self) -> u64 {
        self.weight_bytes
    }
}
