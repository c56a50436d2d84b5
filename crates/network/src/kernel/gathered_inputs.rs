// SPDX-License-Identifier: MIT OR Apache-2.0
//! Gathers the inputs of neighboring positions, one row of the window at a time. Neighbors share
//! most of their inputs.

use super::chunks::{CHUNK_POSITIONS, PositionChunk};
use crate::mask::AxisWindow;
use std::ops::Range;

/// The input of a convolution: the channels of one group, with the windows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConvInput<'a, T = f32> {
    /// The values, channel by channel in row-major order.
    pub(crate) values: &'a [T],
    pub(crate) height: usize,
    pub(crate) width: usize,
    pub(crate) rows: AxisWindow,
    pub(crate) columns: AxisWindow,
    pub(crate) padding: T,
}

/// The layout of the gathered inputs of a row of the window: its phases. A phase holds inputs that
/// are a stride apart, so that the inputs of a tap for neighboring positions are neighbors.
#[derive(Clone, Debug)]
struct WindowRowLayout {
    /// The first column of each phase, counted from the first column of the window.
    phase_columns: Vec<usize>,
    /// The number of inputs of a phase beyond one per position.
    extra_inputs: usize,
    /// The phase of each tap, and the offset of its first input in the phase.
    taps: Vec<(usize, usize)>,
}

impl WindowRowLayout {
    fn new(columns: AxisWindow) -> Self {
        let AxisWindow { kernel, stride, dilation, .. } = columns;
        let (phases, more) = (stride.min(columns.span()), (columns.span() - 1) / stride);
        let tap = |tap| tap * dilation;
        if phases * (CHUNK_POSITIONS + more) <= kernel * CHUNK_POSITIONS {
            let taps = (0..kernel).map(tap).map(|column| (column % stride, column / stride));
            Self { phase_columns: (0..phases).collect(), extra_inputs: more, taps: taps.collect() }
        } else {
            // Taps that are far from each other share no inputs, so each has a phase of its own.
            let taps = (0..kernel).map(|tap| (tap, 0)).collect();
            Self { phase_columns: (0..kernel).map(tap).collect(), extra_inputs: 0, taps }
        }
    }
}

/// Chunks that follow each other in a row.
#[derive(Clone, Debug)]
struct ChunkRun {
    first: PositionChunk,
    /// The offset of the inputs of the run in each phase.
    offset: usize,
    /// The number of inputs of the run in each phase.
    length: usize,
}

/// The gathered inputs of several chunks.
#[derive(Clone, Debug)]
pub(super) struct GatheredInputs<T = f32> {
    layout: WindowRowLayout,
    chunk_runs: Vec<ChunkRun>,
    /// The number of values of a phase over all runs.
    phase_length: usize,
    /// The offset of the inputs of each chunk, for a tap at offset 0.
    pub(super) chunk_offsets: Vec<usize>,
    /// The offset of the inputs of each tap, for each row of the window.
    pub(super) tap_offsets: Vec<usize>,
    /// The number of values of a row of the window.
    pub(super) pitch: usize,
    pub(super) window_rows: Vec<T>,
}

impl<T: Copy + Default> GatheredInputs<T> {
    /// Allocates the buffers for `chunks` chunks and `rows` rows of the window.
    pub(super) fn new(columns: AxisWindow, chunks: usize, rows: usize) -> Self {
        let layout = WindowRowLayout::new(columns);
        let room = layout.phase_columns.len() * (CHUNK_POSITIONS + layout.extra_inputs) * chunks;
        Self {
            chunk_runs: Vec::with_capacity(chunks),
            phase_length: 0,
            chunk_offsets: vec![0; chunks],
            tap_offsets: vec![0; rows * columns.kernel],
            pitch: 0,
            window_rows: vec![T::default(); rows * room],
            layout,
        }
    }

    /// Selects the chunks. If there are fewer than there is room for, the missing ones use the
    /// inputs of the first.
    pub(super) fn select_chunks(&mut self, chunks: &[PositionChunk]) {
        let WindowRowLayout { phase_columns: phases, extra_inputs: more, taps } = &self.layout;
        self.chunk_runs.clear();
        self.chunk_offsets.fill(0);
        let (mut end, mut next) = (0, None);
        for (&chunk, place) in chunks.iter().zip(&mut self.chunk_offsets) {
            match self.chunk_runs.last_mut() {
                Some(last) if next == Some(chunk) => {
                    last.length += CHUNK_POSITIONS;
                    end += CHUNK_POSITIONS;
                }
                _ => {
                    let length = CHUNK_POSITIONS + more;
                    self.chunk_runs.push(ChunkRun { first: chunk, offset: end, length });
                    end += length;
                }
            }
            *place = end - more - CHUNK_POSITIONS;
            next = Some(PositionChunk { x: chunk.x + CHUNK_POSITIONS, y: chunk.y });
        }
        // The offsets are computed anew only if the number of inputs has changed, which is rare.
        if self.phase_length != end {
            (self.phase_length, self.pitch) = (end, end * phases.len());
            for (row, own) in self.tap_offsets.chunks_mut(taps.len()).enumerate() {
                for (to, (phase, at)) in own.iter_mut().zip(taps) {
                    *to = row * self.pitch + phase * end + at;
                }
            }
        }
    }

    /// Gathers some rows of the window, which count from the first row of the first channel.
    #[inline(always)]
    pub(super) fn gather(&mut self, picture: &ConvInput<'_, T>, rows: &Range<usize>) {
        for run in &self.chunk_runs {
            for (at, &phase) in self.layout.phase_columns.iter().enumerate() {
                let to = &mut self.window_rows[at * self.phase_length + run.offset..];
                picture.gather(run, phase, rows, to, self.pitch);
            }
        }
    }
}

impl<T: Copy> ConvInput<'_, T> {
    /// Gathers the inputs of a phase for some rows of the window. Rows are `pitch` values apart in
    /// `to`.
    #[inline(always)]
    fn gather(
        &self,
        run: &ChunkRun,
        phase: usize,
        rows: &Range<usize>,
        to: &mut [T],
        pitch: usize,
    ) {
        let first = run.first.x * self.columns.stride + phase;
        let phase = StridedInputs::new(self.columns, first, run.length, self.width);
        let kernel = self.rows.kernel;
        let (mut channel, mut tap) = (rows.start / kernel, rows.start % kernel);
        for to in to.chunks_mut(pitch).take(rows.len()) {
            let y = self.rows.input_index(run.first.y, tap, self.height);
            let row = y.map(|y| channel * self.height + y);
            let row = row.map(|row| &self.values[row * self.width..][..self.width]);
            phase.gather(row, self.padding, &mut to[..run.length]);
            tap += 1;
            if tap == kernel {
                (channel, tap) = (channel + 1, 0);
            }
        }
    }
}

/// Inputs of a row that are a stride apart.
pub(super) struct StridedInputs {
    /// The inputs that exist, by their number in the sequence.
    inside: Range<usize>,
    /// The column of the first existing input.
    column: usize,
    stride: usize,
}

impl StridedInputs {
    /// Returns a sequence of `length` inputs from column `first`, which counts from the first
    /// column of the padding.
    #[inline(always)]
    pub(super) fn new(columns: AxisWindow, first: usize, length: usize, width: usize) -> Self {
        let AxisWindow { stride, padding_before: before, .. } = columns;
        let from = before.saturating_sub(first).div_ceil(stride).min(length);
        let end = (before + width).saturating_sub(first).div_ceil(stride);
        let inside = from..end.clamp(from, length);
        let column = (first + from * stride).saturating_sub(before).min(width);
        Self { inside, column, stride }
    }

    /// Copies the inputs from a row. Where the row or an input does not exist, it writes the
    /// padding.
    #[inline(always)]
    pub(super) fn gather<T: Copy>(&self, row: Option<&[T]>, padding: T, to: &mut [T]) {
        if row.is_none() || self.inside.len() < to.len() {
            to.fill(padding);
        }
        if let Some(row) = row {
            copy_strided(&row[self.column..], self.stride, &mut to[self.inside.clone()]);
        }
    }
}

/// Copies inputs that are `stride` apart.
#[inline(always)]
fn copy_strided<T: Copy>(from: &[T], stride: usize, to: &mut [T]) {
    match stride {
        1 => copy_short_run(&from[..to.len()], to),
        2 => {
            // Loops over blocks of a known size become vector instructions.
            let (whole, rest) = to.as_chunks_mut::<CHUNK_POSITIONS>();
            let (wide, _) = from.as_chunks::<{ 2 * CHUNK_POSITIONS }>();
            let done = whole.len().min(wide.len());
            for (to, from) in whole.iter_mut().zip(wide) {
                *to = std::array::from_fn(|at| from[2 * at]);
            }
            let rest = whole[done..].as_flattened_mut().iter_mut().chain(rest);
            rest.zip(from[2 * CHUNK_POSITIONS * done..].iter().step_by(2))
                .for_each(|(to, &from)| *to = from);
        }
        stride => to.iter_mut().zip(from.iter().step_by(stride)).for_each(|(to, &from)| *to = from),
    }
}

/// Copies values. Short runs are copied with two accesses that may overlap, because most runs are
/// short.
#[inline(always)]
pub(super) fn copy_short_run<T: Copy>(from: &[T], to: &mut [T]) {
    match to.len() {
        length if length < CHUNK_POSITIONS / 2 => {
            to.iter_mut().zip(from).for_each(|(to, &from)| *to = from);
        }
        length if length < CHUNK_POSITIONS => copy_ends::<_, { CHUNK_POSITIONS / 2 }>(from, to),
        length if length <= 2 * CHUNK_POSITIONS => copy_ends::<_, CHUNK_POSITIONS>(from, to),
        length if length <= 4 * CHUNK_POSITIONS => {
            copy_ends::<_, { 2 * CHUNK_POSITIONS }>(from, to);
        }
        _ => {
            let (whole, _) = to.as_chunks_mut::<{ 2 * CHUNK_POSITIONS }>();
            whole.iter_mut().zip(from.as_chunks().0).for_each(|(to, from)| *to = *from);
            copy_ends::<_, { 2 * CHUNK_POSITIONS }>(from, to);
        }
    }
}

/// Copies the first `N` values and the last `N` values.
#[inline(always)]
fn copy_ends<T: Copy, const N: usize>(from: &[T], to: &mut [T]) {
    let ends = (from.first_chunk::<N>(), from.last_chunk::<N>());
    let (Some(&first), Some(&last)) = ends else { unreachable!("there are {N} values") };
    *to.first_chunk_mut().expect("as many") = first;
    *to.last_chunk_mut().expect("as many") = last;
}
