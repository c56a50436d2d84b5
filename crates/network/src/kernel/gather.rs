// SPDX-License-Identifier: MIT OR Apache-2.0
//! Gathers the inputs of neighboring positions, one row of the window at a time. Neighbors share
//! most of their inputs.

use super::chunks::{CHUNK, Chunk};
use crate::mask::Window;
use std::ops::Range;

/// The input of a convolution: the channels of one group, with the windows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture<'a, T = f32> {
    /// The values, channel by channel in row-major order.
    pub(crate) values: &'a [T],
    pub(crate) height: usize,
    pub(crate) width: usize,
    pub(crate) rows: Window,
    pub(crate) columns: Window,
    pub(crate) padding: T,
}

/// The inputs of a row of the window that are kept, as strands. A strand holds inputs that are a
/// stride apart, so that neighboring positions have neighboring inputs of a tap.
#[derive(Clone, Debug)]
struct Layout {
    /// The first column of each strand, from the first column of the window.
    strands: Vec<usize>,
    /// The number of inputs of a strand beyond one per position.
    more: usize,
    /// The strand of each tap, and the offset of its first input in the strand.
    taps: Vec<(usize, usize)>,
}

impl Layout {
    fn new(columns: Window) -> Self {
        let Window { kernel, stride, dilation, .. } = columns;
        let (strands, more) = (stride.min(columns.span()), (columns.span() - 1) / stride);
        let tap = |tap| tap * dilation;
        if strands * (CHUNK + more) <= kernel * CHUNK {
            let taps = (0..kernel).map(tap).map(|column| (column % stride, column / stride));
            Self { strands: (0..strands).collect(), more, taps: taps.collect() }
        } else {
            // Taps that are far from each other share no inputs, so each has a strand of its own.
            let taps = (0..kernel).map(|tap| (tap, 0)).collect();
            Self { strands: (0..kernel).map(tap).collect(), more: 0, taps }
        }
    }
}

/// Chunks that follow each other in a row.
#[derive(Clone, Debug)]
struct Stretch {
    first: Chunk,
    /// The offset of the inputs of the run in each strand.
    place: usize,
    /// The number of inputs of the run in each strand.
    length: usize,
}

/// The gathered inputs of several chunks.
#[derive(Clone, Debug)]
pub(super) struct Gathered<T = f32> {
    layout: Layout,
    stretches: Vec<Stretch>,
    /// The number of values of a strand over all stretches.
    strand: usize,
    /// The offset of the inputs of each chunk, for a tap at offset 0.
    pub(super) places: Vec<usize>,
    /// The offset of the inputs of each tap, for each row of the window.
    pub(super) taps: Vec<usize>,
    /// The number of values of a row of the window.
    pub(super) pitch: usize,
    /// The gathered values of all rows of the window.
    pub(super) rows: Vec<T>,
}

impl<T: Copy + Default> Gathered<T> {
    /// Allocates the buffers for `chunks` chunks and `rows` rows of the window.
    pub(super) fn new(columns: Window, chunks: usize, rows: usize) -> Self {
        let layout = Layout::new(columns);
        let room = layout.strands.len() * (CHUNK + layout.more) * chunks;
        Self {
            stretches: Vec::with_capacity(chunks),
            strand: 0,
            places: vec![0; chunks],
            taps: vec![0; rows * columns.kernel],
            pitch: 0,
            rows: vec![T::default(); rows * room],
            layout,
        }
    }

    /// Selects the chunks. If there are fewer than there is room for, the missing ones use the
    /// inputs of the first.
    pub(super) fn choose(&mut self, chunks: &[Chunk]) {
        let Layout { strands, more, taps } = &self.layout;
        self.stretches.clear();
        self.places.fill(0);
        let (mut end, mut next) = (0, None);
        for (&chunk, place) in chunks.iter().zip(&mut self.places) {
            match self.stretches.last_mut() {
                Some(last) if next == Some(chunk) => {
                    last.length += CHUNK;
                    end += CHUNK;
                }
                _ => {
                    let length = CHUNK + more;
                    self.stretches.push(Stretch { first: chunk, place: end, length });
                    end += length;
                }
            }
            *place = end - more - CHUNK;
            next = Some(Chunk { x: chunk.x + CHUNK, y: chunk.y });
        }
        // The offsets are computed anew only if the number of inputs has changed, which is rare.
        if self.strand != end {
            (self.strand, self.pitch) = (end, end * strands.len());
            for (row, own) in self.taps.chunks_mut(taps.len()).enumerate() {
                for (to, (strand, at)) in own.iter_mut().zip(taps) {
                    *to = row * self.pitch + strand * end + at;
                }
            }
        }
    }

    /// Gathers some rows of the window, which count from the first row of the first channel.
    #[inline(always)]
    pub(super) fn gather(&mut self, picture: &Picture<'_, T>, rows: &Range<usize>) {
        for stretch in &self.stretches {
            for (at, &strand) in self.layout.strands.iter().enumerate() {
                let to = &mut self.rows[at * self.strand + stretch.place..];
                picture.gather(stretch, strand, rows, to, self.pitch);
            }
        }
    }
}

impl<T: Copy> Picture<'_, T> {
    /// Gathers the inputs of a strand for some rows of the window. Rows are `pitch` values apart in
    /// `to`.
    #[inline(always)]
    fn gather(
        &self,
        stretch: &Stretch,
        strand: usize,
        rows: &Range<usize>,
        to: &mut [T],
        pitch: usize,
    ) {
        let first = stretch.first.x * self.columns.stride + strand;
        let strand = Strand::new(self.columns, first, stretch.length, self.width);
        let kernel = self.rows.kernel;
        let (mut channel, mut tap) = (rows.start / kernel, rows.start % kernel);
        for to in to.chunks_mut(pitch).take(rows.len()) {
            let y = self.rows.input(stretch.first.y, tap, self.height);
            let row = y.map(|y| channel * self.height + y);
            let row = row.map(|row| &self.values[row * self.width..][..self.width]);
            strand.gather(row, self.padding, &mut to[..stretch.length]);
            tap += 1;
            if tap == kernel {
                (channel, tap) = (channel + 1, 0);
            }
        }
    }
}

/// Inputs of a row that are a stride apart.
pub(super) struct Strand {
    /// The inputs that exist, by their number in the strand.
    inside: Range<usize>,
    /// The column of the first existing input.
    column: usize,
    stride: usize,
}

impl Strand {
    /// Returns a strand of `length` inputs from column `first`, which counts from the first column
    /// of the padding.
    #[inline(always)]
    pub(super) fn new(columns: Window, first: usize, length: usize, width: usize) -> Self {
        let Window { stride, before, .. } = columns;
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
            take(&row[self.column..], self.stride, &mut to[self.inside.clone()]);
        }
    }
}

/// Copies inputs that are `stride` apart.
#[inline(always)]
fn take<T: Copy>(from: &[T], stride: usize, to: &mut [T]) {
    match stride {
        1 => copy(&from[..to.len()], to),
        2 => {
            // Loops over blocks of a known size become vector instructions.
            let (whole, rest) = to.as_chunks_mut::<CHUNK>();
            let (wide, _) = from.as_chunks::<{ 2 * CHUNK }>();
            let done = whole.len().min(wide.len());
            for (to, from) in whole.iter_mut().zip(wide) {
                *to = std::array::from_fn(|at| from[2 * at]);
            }
            let rest = whole[done..].as_flattened_mut().iter_mut().chain(rest);
            rest.zip(from[2 * CHUNK * done..].iter().step_by(2)).for_each(|(to, &from)| *to = from);
        }
        stride => to.iter_mut().zip(from.iter().step_by(stride)).for_each(|(to, &from)| *to = from),
    }
}

/// Copies values. Short runs are copied with two accesses that may overlap, because most stretches
/// are short.
#[inline(always)]
pub(super) fn copy<T: Copy>(from: &[T], to: &mut [T]) {
    match to.len() {
        length if length < CHUNK / 2 => to.iter_mut().zip(from).for_each(|(to, &from)| *to = from),
        length if length < CHUNK => copy_ends::<_, { CHUNK / 2 }>(from, to),
        length if length <= 2 * CHUNK => copy_ends::<_, CHUNK>(from, to),
        length if length <= 4 * CHUNK => copy_ends::<_, { 2 * CHUNK }>(from, to),
        _ => {
            let (whole, _) = to.as_chunks_mut::<{ 2 * CHUNK }>();
            whole.iter_mut().zip(from.as_chunks().0).for_each(|(to, from)| *to = *from);
            copy_ends::<_, { 2 * CHUNK }>(from, to);
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
