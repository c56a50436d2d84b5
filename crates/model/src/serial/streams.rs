// SPDX-License-Identifier: MIT OR Apache-2.0
//! `feed = "parallel"`: every lane is given the streams of its regions, one after the other.

use foveate_design::SerialDesign;

use crate::number::index;

/// The streams of a frame, as they come: by slot, by position in the stream, by lane.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Streams {
    lanes: usize,
    fold: usize,
    /// Side of a region with its halo, N + 2r.
    stream_side: usize,
    pixels: Vec<u16>,
}

impl Streams {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let (lanes, fold) = (index(design.lanes()), index(design.fold()));
        let stream_side = index(design.stream_side());
        Self { lanes, fold, stream_side, pixels: vec![0; lanes * fold * stream_side * stream_side] }
    }

    pub(super) fn lanes(&self) -> usize {
        self.lanes
    }

    /// Pixels per lane of a frame.
    pub(super) fn clocks(&self) -> usize {
        self.fold * self.stream_side * self.stream_side
    }

    /// Takes number `at` of the frame: one pixel per lane.
    pub(super) fn write(&mut self, at: usize, pixels: &[u16]) {
        self.pixels[at * self.lanes..][..self.lanes].copy_from_slice(pixels);
    }

    pub(super) fn stream(&self, region: usize) -> impl Iterator<Item = u16> + '_ {
        let length = self.stream_side * self.stream_side;
        self.pixels[self.start(region)..].iter().step_by(self.lanes).take(length).copied()
    }

    /// Where the first pixel of a region is.
    fn start(&self, region: usize) -> usize {
        let (lane, slot) = (region / self.fold, region % self.fold);
        slot * self.stream_side * self.stream_side * self.lanes + lane
    }
}
