// SPDX-License-Identifier: MIT OR Apache-2.0
//! The buffer of `feed = "parallel"`: every lane takes the streams of its regions, one after the
//! other.

use foveate_design::SerialDesign;

use crate::conversions::index;

/// The streams of a frame in the order in which they come: by slot, by position in the stream, by
/// lane.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LaneStreams {
    lanes: usize,
    fold: usize,
    /// Side of a region with its halo, N + 2r, in pixels.
    stream_side: usize,
    pixels: Vec<u16>,
}

impl LaneStreams {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let (lanes, fold) = (index(design.lanes()), index(design.fold()));
        let stream_side = index(design.stream_side());
        Self { lanes, fold, stream_side, pixels: vec![0; lanes * fold * stream_side * stream_side] }
    }

    pub(super) fn lanes(&self) -> usize {
        self.lanes
    }

    /// Returns the number of pixels per lane of a frame.
    pub(super) fn clocks(&self) -> usize {
        self.fold * self.stream_side * self.stream_side
    }

    /// Writes pixel number `at` of every lane.
    pub(super) fn write(&mut self, at: usize, pixels: &[u16]) {
        self.pixels[at * self.lanes..][..self.lanes].copy_from_slice(pixels);
    }

    pub(super) fn stream(&self, region: usize) -> impl Iterator<Item = u16> + '_ {
        let length = self.stream_side * self.stream_side;
        self.pixels[self.start_index(region)..].iter().step_by(self.lanes).take(length).copied()
    }

    /// Returns the index of the first pixel of a region.
    fn start_index(&self, region: usize) -> usize {
        let (lane, slot) = (region / self.fold, region % self.fold);
        slot * self.stream_side * self.stream_side * self.lanes + lane
    }
}
