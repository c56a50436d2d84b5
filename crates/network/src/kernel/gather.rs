// SPDX-License-Identifier: MIT OR Apache-2.0
//! Gathers what neighboring positions see, row of the window by row: neighbors share most of their inputs.

use super::chunks::{CHUNK, Chunk};
use crate::mask::Window;
use std::ops::Range;

/// What a convolution sees: the channels of its group, and the windows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture<'a, T = f32> {
    /// Channel by channel, row by row.
    pub(crate) values: &'a [T],
    pub(crate) height: usize,
    pub(crate) width: usize,
    pub(crate) rows: Window,
    pub(crate) columns: Window,
    pub(crate) padding: T,
}

/// Which inputs of a row of the window are kept: strands of inputs that are a stride apart, so that the inputs of a tap are neighbors for
/// positions that are.
#[derive(Clone, Debug)]
struct Layout {
    /// Where each strand begins, in columns from the window's first.
    strands: Vec<usize>,
    /// Inputs of a strand beyond one for each position.
    more: usize,
    /// The strand of each tap, and how many inputs of it come before.
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
            // Taps far from each other share no inputs.
            let taps = (0..kernel).map(|tap| (tap, 0)).collect();
            Self { strands: (0..kernel).map(tap).collect(), more: 0, taps }
        }
    }
}

/// Chunks that follow each other in a row.
#[derive(Clone, Debug)]
struct Stretch {
    first: Chunk,
    /// Where its inputs begin in each strand, and how many there are.
    place: usize,
    length: usize,
}

/// The gathered inputs of some chunks.
#[derive(Clone, Debug)]
pub(super) struct Gathered<T = f32> {
    layout: Layout,
    stretches: Vec<Stretch>,
    /// Values of a strand of all stretches.
    strand: usize,
    /// Where the inputs of each chunk begin, for a tap that begins at 0.
    pub(super) places: Vec<usize>,
    /// Where the inputs of each tap begin.
    pub(super) taps: Vec<usize>,
    /// Values of a row of the window.
    pub(super) pitch: usize,
    /// The rows.
    pub(super) rows: Vec<T>,
}

impl<T: Copy + Default> Gathered<T> {
    /// Room for so many chunks and rows of the window.
    pub(super) fn new(columns: Window, chunks: usize, rows: usize) -> Self {
        let layout = Layout::new(columns);
        let room = layout.strands.len() * (CHUNK + layout.more) * chunks;
        Self {
            stretches: Vec::with_capacity(chunks),
            strand: 0,
            places: vec![0; chunks],
            taps: vec![0; columns.kernel],
            pitch: 0,
            rows: vec![T::default(); rows * room],
            layout,
        }
    }

    /// Chooses the chunks. One that is missing has the inputs of the first.
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
        self.strand = end;
        self.pitch = end * strands.len();
        self.taps.iter_mut().zip(taps).for_each(|(to, (strand, at))| *to = strand * end + at);
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
    /// Gathers the inputs of a strand for some rows of the window, each `pitch` values from the one before.
    #[inline(always)]
    fn gather(
        &self,
        stretch: &Stretch,
        strand: usize,
        rows: &Range<usize>,
        to: &mut [T],
        pitch: usize,
    ) {
        let Window { stride, before, .. } = self.columns;
        // The columns count from the first one of the padding.
        let first = stretch.first.x * stride + strand;
        let from = before.saturating_sub(first).div_ceil(stride).min(stretch.length);
        let end = (before + self.width).saturating_sub(first).div_ceil(stride);
        let inside = from..end.clamp(from, stretch.length);
        let column = (first + from * stride).saturating_sub(before).min(self.width);
        let kernel = self.rows.kernel;
        let (mut channel, mut tap) = (rows.start / kernel, rows.start % kernel);
        for to in to.chunks_mut(pitch).take(rows.len()) {
            let to = &mut to[..stretch.length];
            let y = self.rows.input(stretch.first.y, tap, self.height);
            if y.is_none() || inside.len() < stretch.length {
                to.fill(self.padding);
            }
            if let Some(y) = y {
                let row = (channel * self.height + y) * self.width;
                take(&self.values[row + column..row + self.width], stride, &mut to[inside.clone()]);
            }
            tap += 1;
            if tap == kernel {
                (channel, tap) = (channel + 1, 0);
            }
        }
    }
}

/// Every so many inputs.
#[inline(always)]
fn take<T: Copy>(from: &[T], stride: usize, to: &mut [T]) {
    match stride {
        1 => copy(&from[..to.len()], to),
        2 => {
            let from = &from[..(2 * to.len()).saturating_sub(1)];
            to.iter_mut().enumerate().for_each(|(at, to)| *to = from[2 * at]);
        }
        stride => to.iter_mut().zip(from.iter().step_by(stride)).for_each(|(to, &from)| *to = from),
    }
}

/// Copies with two accesses that may overlap as long as that is enough: most stretches are short.
#[inline(always)]
fn copy<T: Copy>(from: &[T], to: &mut [T]) {
    match to.len() {
        length if length < CHUNK => to.copy_from_slice(from),
        length if length <= 2 * CHUNK => copy_ends::<_, CHUNK>(from, to),
        length if length <= 4 * CHUNK => copy_ends::<_, { 2 * CHUNK }>(from, to),
        _ => {
            let (whole, _) = to.as_chunks_mut::<{ 2 * CHUNK }>();
            whole.iter_mut().zip(from.as_chunks().0).for_each(|(to, from)| *to = *from);
            copy_ends::<_, { 2 * CHUNK }>(from, to);
        }
    }
}

/// Copies the first `N` values and the last.
#[inline(always)]
fn copy_ends<T: Copy, const N: usize>(from: &[T], to: &mut [T]) {
    let ends = (from.first_chunk::<N>(), from.last_chunk::<N>());
    let (Some(&first), Some(&last)) = ends else { unreachable!("there are {N} values") };
    *to.first_chunk_mut().expect("as many") = first;
    *to.last_chunk_mut().expect("as many") = last;
}
