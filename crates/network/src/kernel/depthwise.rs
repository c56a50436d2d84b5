// SPDX-License-Identifier: MIT OR Apache-2.0
//! Depthwise convolution of floating-point values. Every output is summed tap by tap from its bias;
//! padding adds products of 0.
//!
//! The inputs of an area are copied, with their padding, into planes: one for each phase of the
//! stride along either axis. In a plane the inputs of a tap have the same arrangement as the
//! outputs, at a constant offset. Tiles therefore need not end with a row, so that all values of a
//! tile are used in narrow inputs, too.

use super::gathered_inputs::{ConvInput, StridedInputs, copy_short_run};
use super::output_areas::OutputArea;
use crate::activation::Activation;
use crate::mask::AxisWindow;
use foveate_pixels::vectors::{InstructionSet, PanelTask};

/// The convolution of one channel.
pub(crate) struct DepthwiseChannel<'a> {
    pub(crate) picture: ConvInput<'a>,
    /// The weights of the kernel in row-major order.
    pub(crate) weights: &'a [f32],
    pub(crate) bias: f32,
    pub(crate) layouts: &'a [AreaLayout],
    /// The channel's outputs, in rows of `width`.
    pub(crate) outputs: &'a mut [f32],
    pub(crate) width: usize,
    pub(crate) activation: Activation,
}

impl DepthwiseChannel<'_> {
    /// Computes the outputs of all areas.
    pub(crate) fn convolve(self, level: InstructionSet, planes: &mut AreaBuffers) {
        level.run_panels(DepthwiseTask(self, planes));
    }
}

/// The convolution in tiles of two panels of outputs, which are four registers.
struct DepthwiseTask<'a>(DepthwiseChannel<'a>, &'a mut AreaBuffers);

impl PanelTask for DepthwiseTask<'_> {
    #[inline(always)]
    fn run<const VALUES: usize, const FUSED: bool>(self) {
        let Self(
            DepthwiseChannel { picture, weights, bias, layouts, outputs, width, activation },
            planes,
        ) = self;
        for layout in layouts {
            planes.enlarge(layout, 2 * VALUES);
            layout.gather(&picture, &mut planes.inputs);
            for first in (0..layout.output_span).step_by(2 * VALUES) {
                let inputs = &planes.inputs[first..];
                let mut sums = tile::<VALUES, FUSED>(inputs, &layout.taps, weights, bias);
                activation.apply_to_all(sums.as_flattened_mut());
                planes.outputs[first..][..2 * VALUES].copy_from_slice(sums.as_flattened());
            }
            for (row, y) in layout.area.rows.clone().enumerate() {
                let to = &mut outputs[y * width..][layout.area.columns.clone()];
                copy_short_run(&planes.outputs[row * layout.pitch..][..to.len()], to);
            }
        }
    }
}

/// The buffers for the inputs and outputs of an area. Each thread keeps one, so that its memory is
/// reused.
#[derive(Default)]
pub(crate) struct AreaBuffers {
    inputs: Vec<f32>,
    outputs: Vec<f32>,
}

impl AreaBuffers {
    /// Enlarges the buffers so that the area fits in whole tiles.
    fn enlarge(&mut self, layout: &AreaLayout, tile: usize) {
        let room = layout.inputs + tile;
        if self.inputs.len() < room {
            self.inputs.resize(room, 0.0);
            self.outputs.resize(room, 0.0);
        }
    }
}

/// The arrangement of the inputs and outputs of an area in memory.
pub(crate) struct AreaLayout {
    area: OutputArea,
    /// The rows of a plane of inputs.
    height: usize,
    /// The length of a row of inputs or outputs, in values. The values behind the outputs of a row
    /// are not used.
    pitch: usize,
    /// The number of values of all planes of inputs.
    inputs: usize,
    output_span: usize,
    /// The offset of the inputs of each tap.
    taps: Vec<usize>,
}

impl AreaLayout {
    pub(crate) fn new(area: OutputArea, rows: AxisWindow, columns: AxisWindow) -> Self {
        let [height, pitch] =
            [area.rows.len() + extra_inputs(rows), area.columns.len() + extra_inputs(columns)];
        let mut layout = Self {
            height,
            pitch,
            inputs: phase_count(rows) * phase_count(columns) * height * pitch,
            output_span: (area.rows.len() - 1) * pitch + area.columns.len(),
            taps: Vec::with_capacity(rows.kernel * columns.kernel),
            area,
        };
        for row in (0..rows.kernel).map(|tap| tap * rows.dilation) {
            for column in (0..columns.kernel).map(|tap| tap * columns.dilation) {
                layout.taps.push(layout.input_offset([row, column], [rows, columns]));
            }
        }
        layout
    }

    /// The offset of an input by its row and column, which count from the first input of the area.
    #[inline(always)]
    fn input_offset(&self, [row, column]: [usize; 2], [rows, columns]: [AxisWindow; 2]) -> usize {
        let plane = row % rows.stride * phase_count(columns) + column % columns.stride;
        (plane * self.height + row / rows.stride) * self.pitch + column / columns.stride
    }

    /// Copies the inputs of the area into the planes.
    #[inline(always)]
    fn gather(&self, picture: &ConvInput<'_>, to: &mut [f32]) {
        let windows @ [rows, columns] = [picture.rows, picture.columns];
        for column in 0..phase_count(columns) {
            let first = self.area.columns.start * columns.stride + column;
            let strand = StridedInputs::new(columns, first, self.pitch, picture.width);
            for more in 0..phase_count(rows) {
                let plane = &mut to[self.input_offset([more, column], windows)..];
                for (row, to) in plane.chunks_mut(self.pitch).take(self.height).enumerate() {
                    let y = (self.area.rows.start + row) * rows.stride + more;
                    let y = y.checked_sub(rows.padding_before).filter(|&y| y < picture.height);
                    let from = y.map(|y| &picture.values[y * picture.width..][..picture.width]);
                    strand.gather(from, picture.padding, to);
                }
            }
        }
    }
}

/// Returns the sums of the outputs of a tile. The compiler keeps two halves in registers, but not
/// one array of twice the length.
#[inline(always)]
fn tile<const VALUES: usize, const FUSED: bool>(
    inputs: &[f32],
    taps: &[usize],
    weights: &[f32],
    bias: f32,
) -> [[f32; VALUES]; 2] {
    let mut sums = [[bias; VALUES]; 2];
    for (&tap, &weight) in taps.iter().zip(weights) {
        let inputs = &inputs[tap..].as_chunks::<VALUES>().0[..2];
        for part in 0..2 {
            for value in 0..VALUES {
                let (input, sum) = (inputs[part][value], &mut sums[part][value]);
                *sum = if FUSED { weight.mul_add(input, *sum) } else { weight * input + *sum };
            }
        }
    }
    sums
}

/// The number of inputs of a plane along an axis beyond one per output.
fn extra_inputs(window: AxisWindow) -> usize {
    (window.span() - 1) / window.stride
}

/// The number of planes along an axis: one for each phase of the stride that a window sees.
fn phase_count(window: AxisWindow) -> usize {
    window.stride.min(window.span())
}
