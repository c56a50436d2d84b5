// SPDX-License-Identifier: MIT OR Apache-2.0
//! Gathers the inputs of any positions side by side, as if they were neighbors.

use crate::mask::{Mask, Window};
use std::ops::Range;

/// Neighboring positions of a row that are gathered at once.
pub(crate) const CHUNK: usize = 8;

/// The first of [`CHUNK`] neighboring positions, as far as the row has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chunk {
    pub(crate) x: usize,
    pub(crate) y: usize,
}

/// The positions of a mask as chunks. A chunk may hold positions that are not in the mask, and two chunks may share some.
pub(crate) fn chunks(at: &Mask) -> Vec<Chunk> {
    let mut found = Vec::new();
    let last = at.width().saturating_sub(CHUNK);
    for y in 0..at.height() {
        let mut done = 0;
        for (start, length) in at.runs(y) {
            let mut x = start.max(done);
            while x < start + length {
                found.push(Chunk { x: x.min(last), y });
                x += CHUNK;
            }
            done = x;
        }
    }
    found
}

/// What a convolution sees: the channels of its group, and the windows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture<'a> {
    /// Channel by channel, row by row.
    pub(crate) values: &'a [f32],
    pub(crate) height: usize,
    pub(crate) width: usize,
    pub(crate) rows: Window,
    pub(crate) columns: Window,
}

/// Some positions of a chunk, and the input of the first.
#[derive(Clone, Debug)]
struct Inside {
    lanes: Range<usize>,
    x: usize,
}

impl Picture<'_> {
    /// Inputs of an output.
    fn depth(&self) -> usize {
        self.values.len() / (self.height * self.width) * self.rows.kernel * self.columns.kernel
    }

    /// Where each input of an output is, from the place of its first one.
    pub(super) fn offsets(&self) -> Vec<usize> {
        let places = self.height * self.width;
        let offset = |at: usize| {
            let (tap, column) = (at / self.columns.kernel, at % self.columns.kernel);
            let (channel, row) = (tap / self.rows.kernel, tap % self.rows.kernel);
            let down = row * self.rows.dilation * self.width;
            channel * places + down + column * self.columns.dilation
        };
        (0..self.depth()).map(offset).collect()
    }

    /// Gathers some inputs of all positions of the chunks: for every panel of [`CHUNK`] positions per chunk, as many rows as there are inputs;
    /// 0 where a chunk is missing and where an input is padding.
    #[inline(always)]
    pub(super) fn gather<const LANES: usize>(
        &self,
        offsets: &[usize],
        inputs: &Range<usize>,
        chunks: &[Chunk],
        gathered: &mut [[f32; LANES]],
    ) {
        let depth = inputs.len();
        if let Some(start) = self
            .neighbors(chunks)
            .filter(|_| chunks.len() * CHUNK == gathered.len() / depth * LANES)
        {
            // Row by row through all panels, so that memory is read in its order.
            for (row, &offset) in offsets[inputs.clone()].iter().enumerate() {
                let (values, _) = self.values[start + offset..].as_chunks::<LANES>();
                for (panel, values) in gathered[row..].iter_mut().step_by(depth).zip(values) {
                    *panel = *values;
                }
            }
            return;
        }
        for (panel, chunks) in gathered.chunks_mut(depth).zip(chunks.chunks(LANES / CHUNK)) {
            for lane in 0..LANES / CHUNK {
                let lanes = lane * CHUNK..(lane + 1) * CHUNK;
                match chunks.get(lane).map(|&chunk| (chunk, self.inside(chunk))) {
                    None => panel.iter_mut().for_each(|panel| panel[lanes.clone()].fill(0.0)),
                    Some((chunk, None)) => self.gather_border(inputs.start, chunk, lanes, panel),
                    Some((_, Some(start))) => {
                        for (&offset, panel) in offsets[inputs.clone()].iter().zip(panel.iter_mut())
                        {
                            self.take(&self.values[start + offset..], &mut panel[lanes.clone()]);
                        }
                    }
                }
            }
        }
    }

    /// Where the first input of the chunks is, if they are neighbors without gaps and none of their inputs is padding.
    fn neighbors(&self, chunks: &[Chunk]) -> Option<usize> {
        let (first, last) = (chunks.first()?, chunks.last()?);
        let is_next =
            |(at, chunk): (usize, &Chunk)| (chunk.x, chunk.y) == (first.x + at * CHUNK, first.y);
        let are_neighbors = self.columns.stride == 1 && chunks.iter().enumerate().all(is_next);
        let start = if are_neighbors { self.inside(*first)? } else { return None };
        self.inside(*last).map(|_| start)
    }

    /// Where the first input of a chunk is, if none of its inputs is padding.
    pub(super) fn inside(&self, chunk: Chunk) -> Option<usize> {
        let Self { rows, columns, .. } = self;
        let y = (chunk.y * rows.stride).checked_sub(rows.before)?;
        let x = (chunk.x * columns.stride).checked_sub(columns.before)?;
        let right = x + (CHUNK - 1) * columns.stride + columns.span();
        (y + rows.span() <= self.height && right <= self.width).then_some(y * self.width + x)
    }

    /// Every so many inputs, one for each position.
    #[inline(always)]
    pub(super) fn take(&self, inputs: &[f32], to: &mut [f32]) {
        match self.columns.stride {
            1 => to.copy_from_slice(&inputs[..CHUNK]),
            2 => {
                let inputs: &[f32; 2 * CHUNK - 1] =
                    inputs.first_chunk().expect("the last input is inside");
                to.iter_mut().enumerate().for_each(|(at, to)| *to = inputs[2 * at]);
            }
            stride => to
                .iter_mut()
                .zip(inputs.iter().step_by(stride))
                .for_each(|(to, &input)| *to = input),
        }
    }

    /// The same where some inputs are padding.
    #[inline(never)]
    pub(super) fn gather_border<const LANES: usize>(
        &self,
        from: usize,
        chunk: Chunk,
        lanes: Range<usize>,
        panel: &mut [[f32; LANES]],
    ) {
        let Self { rows, columns, height, width, .. } = *self;
        let inside: Vec<Inside> =
            (0..columns.kernel).map(|tap| self.inside_row(chunk, tap)).collect();
        let (mut tap, mut column) = (from / columns.kernel, from % columns.kernel);
        for to in panel {
            let to = &mut to[lanes.clone()];
            to.fill(0.0);
            let (channel, row) = (tap / rows.kernel, tap % rows.kernel);
            if let Some(y) = rows.input(chunk.y, row, height) {
                let Inside { lanes, x } = inside[column].clone();
                let inputs = self.values[(channel * height + y) * width + x..].iter();
                let inputs = inputs.step_by(columns.stride);
                to[lanes].iter_mut().zip(inputs).for_each(|(to, &input)| *to = input);
            }
            column += 1;
            if column == columns.kernel {
                (tap, column) = (tap + 1, 0);
            }
        }
    }

    /// The positions of a chunk whose input of a tap is no padding: they are neighbors.
    fn inside_row(&self, chunk: Chunk, tap: usize) -> Inside {
        let input = |lane: &usize| self.columns.input(chunk.x + lane, tap, self.width);
        let first = (0..CHUNK).find(|lane| input(lane).is_some()).unwrap_or(CHUNK);
        let end = (first..CHUNK).find(|lane| input(lane).is_none()).unwrap_or(CHUNK);
        Inside { lanes: first..end, x: input(&first).filter(|_| first < end).unwrap_or(0) }
    }
}
