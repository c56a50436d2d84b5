// SPDX-License-Identifier: MIT OR Apache-2.0
//! Convolution of each channel by itself. Every output is summed tap by tap from its bias on; padding adds products of 0.
//!
//! The inputs of an area are copied into a plane with its padding, or into one for each of the inputs between two outputs of a stride. There
//! the inputs of a tap lie as the outputs do, so many values further on, and tiles need not end with a row: in small pictures, too, all lanes
//! of a tile are used.

use super::areas::Area;
use super::gather::{Picture, Strand, copy};
use crate::mask::Window;
use foveate_lanes::{Level, PanelTask};

/// One channel.
pub(crate) struct Depthwise<'a, F> {
    pub(crate) picture: Picture<'a>,
    /// Row by row.
    pub(crate) weights: &'a [f32],
    pub(crate) bias: f32,
    pub(crate) layouts: &'a [Layout],
    /// The channel's outputs, in rows of `width`.
    pub(crate) outputs: &'a mut [f32],
    pub(crate) width: usize,
    pub(crate) finish: F,
}

impl<F: Fn(f32) -> f32> Depthwise<'_, F> {
    /// Computes the outputs of the layouts.
    pub(crate) fn convolve(self, level: Level, planes: &mut Planes) {
        level.run_panels(Tiles(self, planes));
    }
}

/// The work in tiles of two panels of outputs: those of four registers.
struct Tiles<'a, F>(Depthwise<'a, F>, &'a mut Planes);

impl<F: Fn(f32) -> f32> PanelTask for Tiles<'_, F> {
    #[inline(always)]
    fn run<const LANES: usize, const FUSED: bool>(self) {
        let Self(Depthwise { picture, weights, bias, layouts, outputs, width, finish }, planes) =
            self;
        for layout in layouts {
            planes.fit(layout, 2 * LANES);
            layout.gather(&picture, &mut planes.inputs);
            for first in (0..layout.places).step_by(2 * LANES) {
                let inputs = &planes.inputs[first..];
                let sums = tile::<LANES, FUSED>(inputs, &layout.taps, weights, bias);
                let to = planes.outputs[first..].as_chunks_mut().0;
                for (to, sums) in to.iter_mut().zip(sums) {
                    *to = sums.map(&finish);
                }
            }
            for (row, y) in layout.area.rows.clone().enumerate() {
                let to = &mut outputs[y * width..][layout.area.columns.clone()];
                copy(&planes.outputs[row * layout.pitch..][..to.len()], to);
            }
        }
    }
}

/// Inputs and outputs of an area. Threads keep one each, so that its memory is used again.
#[derive(Default)]
pub(crate) struct Planes {
    inputs: Vec<f32>,
    outputs: Vec<f32>,
}

impl Planes {
    /// Makes room for whole tiles.
    fn fit(&mut self, layout: &Layout, tile: usize) {
        let room = layout.inputs + tile;
        if self.inputs.len() < room {
            self.inputs.resize(room, 0.0);
            self.outputs.resize(room, 0.0);
        }
    }
}

/// Where the inputs of an area lie, and how its outputs.
pub(crate) struct Layout {
    area: Area,
    /// Rows of a plane of inputs, and values of a row of inputs or outputs. What lies behind the outputs of a row means nothing.
    height: usize,
    pitch: usize,
    /// Values of the inputs, and from the first output to the last.
    inputs: usize,
    places: usize,
    /// Where the inputs of each tap begin.
    taps: Vec<usize>,
}

impl Layout {
    pub(crate) fn new(area: Area, rows: Window, columns: Window) -> Self {
        let [height, pitch] = [area.rows.len() + more(rows), area.columns.len() + more(columns)];
        let mut layout = Self {
            height,
            pitch,
            inputs: planes(rows) * planes(columns) * height * pitch,
            places: (area.rows.len() - 1) * pitch + area.columns.len(),
            taps: Vec::with_capacity(rows.kernel * columns.kernel),
            area,
        };
        for row in (0..rows.kernel).map(|tap| tap * rows.dilation) {
            for column in (0..columns.kernel).map(|tap| tap * columns.dilation) {
                layout.taps.push(layout.place([row, column], [rows, columns]));
            }
        }
        layout
    }

    /// Where an input is, which counts from the first of the area.
    #[inline(always)]
    fn place(&self, [row, column]: [usize; 2], [rows, columns]: [Window; 2]) -> usize {
        let plane = row % rows.stride * planes(columns) + column % columns.stride;
        (plane * self.height + row / rows.stride) * self.pitch + column / columns.stride
    }

    /// Copies the inputs.
    #[inline(always)]
    fn gather(&self, picture: &Picture<'_>, to: &mut [f32]) {
        let windows @ [rows, columns] = [picture.rows, picture.columns];
        for column in 0..planes(columns) {
            let first = self.area.columns.start * columns.stride + column;
            let strand = Strand::new(columns, first, self.pitch, picture.width);
            for more in 0..planes(rows) {
                let plane = &mut to[self.place([more, column], windows)..];
                for (row, to) in plane.chunks_mut(self.pitch).take(self.height).enumerate() {
                    let y = (self.area.rows.start + row) * rows.stride + more;
                    let y = y.checked_sub(rows.before).filter(|&y| y < picture.height);
                    let from = y.map(|y| &picture.values[y * picture.width..][..picture.width]);
                    strand.gather(from, picture.padding, to);
                }
            }
        }
    }
}

/// The sums of the outputs of a tile. Two parts of it stay in registers where one of twice the length does not.
#[inline(always)]
fn tile<const LANES: usize, const FUSED: bool>(
    inputs: &[f32],
    taps: &[usize],
    weights: &[f32],
    bias: f32,
) -> [[f32; LANES]; 2] {
    let mut sums = [[bias; LANES]; 2];
    for (&tap, &weight) in taps.iter().zip(weights) {
        let inputs = &inputs[tap..].as_chunks::<LANES>().0[..2];
        for part in 0..2 {
            for lane in 0..LANES {
                let (input, sum) = (inputs[part][lane], &mut sums[part][lane]);
                *sum = if FUSED { weight.mul_add(input, *sum) } else { weight * input + *sum };
            }
        }
    }
    sums
}

/// Inputs of a plane along an axis beyond one for each output.
fn more(window: Window) -> usize {
    (window.span() - 1) / window.stride
}

/// Planes along an axis: one for each of the inputs between two outputs that an output sees.
fn planes(window: Window) -> usize {
    window.stride.min(window.span())
}
