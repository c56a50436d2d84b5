// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pixels of a frame as they are taken, and the stream of each region ([`FrameIntake`]).
//! There is a buffer for each feed. With `feed = "parallel"`, every lane takes the streams of
//! its regions, one after the other ([`LaneStreams`]). With `feed = "raster"`, the padded frame
//! comes pixel by pixel, and the array makes the streams of all regions from it
//! ([`RasterFeedFrame`]).

use crate::conversions::index;
use foveate_design::{PixelFeed, SerialDesign};

/// The raw pixels of one frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FrameIntake {
    /// Number of pixels of this frame that have been taken.
    taken: usize,
    buffer: FeedBuffer,
}

#[derive(Clone, Debug, PartialEq)]
enum FeedBuffer {
    Streams(LaneStreams),
    Raster(RasterFeedFrame),
}

impl FrameIntake {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let frame = match design.feed() {
            PixelFeed::Parallel => FeedBuffer::Streams(LaneStreams::new(design)),
            PixelFeed::Raster => FeedBuffer::Raster(RasterFeedFrame::new(design)),
        };
        Self { taken: 0, buffer: frame }
    }

    pub(super) fn port_pixels(&self) -> usize {
        match &self.buffer {
            FeedBuffer::Streams(streams) => streams.lanes(),
            FeedBuffer::Raster(_) => 1,
        }
    }

    /// Resets the intake: the next pixel is the first of a frame.
    pub(super) fn reset(&mut self) {
        self.taken = 0;
    }

    /// Returns true if no pixel has been taken since the reset.
    pub(super) fn is_empty(&self) -> bool {
        self.taken == 0
    }

    /// Returns true if the last pixel of a frame has been taken, and none of the next frame.
    pub(super) fn is_full(&self) -> bool {
        let frame = match &self.buffer {
            FeedBuffer::Streams(streams) => streams.clocks(),
            FeedBuffer::Raster(raster) => raster.pixels(),
        };
        self.taken == frame
    }

    /// Takes the pixels of the port, and returns the number of clocks for which they are written.
    pub(super) fn take(&mut self, pixels: &[u16]) -> u64 {
        if self.is_full() {
            self.taken = 0;
        }
        let at = self.taken;
        self.taken += 1;
        match &mut self.buffer {
            FeedBuffer::Streams(streams) => {
                streams.write(at, pixels);
                1
            }
            FeedBuffer::Raster(raster) => raster.write(at, pixels[0]),
        }
    }

    /// Returns the number of clocks that writing the rest of the current frame takes, if it comes
    /// without a gap.
    pub(super) fn clocks_left(&self) -> u64 {
        match &self.buffer {
            FeedBuffer::Streams(streams) => (streams.clocks() - self.taken) as u64,
            FeedBuffer::Raster(raster) => raster.clocks_from(self.taken),
        }
    }

    /// Writes the pixels of a region with its halo to `out`, in row-major order.
    pub(super) fn stream(&self, region: usize, out: &mut Vec<u16>) {
        out.clear();
        match &self.buffer {
            FeedBuffer::Streams(streams) => out.extend(streams.stream(region)),
            FeedBuffer::Raster(raster) => raster.stream(region, out),
        }
    }
}

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

/// The pixels of a padded frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RasterFeedFrame {
    columns: GridAxis,
    rows: GridAxis,
    pixels: Vec<u16>,
}

/// One of the two axes of the grid of regions.
#[derive(Clone, Debug, PartialEq)]
struct GridAxis {
    /// Number of regions along the axis.
    regions: usize,
    /// Side of a region N in pixels.
    side: usize,
    /// Halo of a region r in pixels.
    halo: usize,
    /// For every coordinate, the number of positions in windows that show it: c of
    /// `docs/serial.md`.
    place_counts: Vec<u32>,
}

impl GridAxis {
    fn new(design: SerialDesign<'_>, regions: u32, shown: impl Fn(u32) -> u32) -> Self {
        let side = design.region_size();
        Self {
            regions: index(regions),
            side: index(side),
            halo: index(design.halo()),
            place_counts: (0..regions * side).map(shown).collect(),
        }
    }

    fn size(&self) -> usize {
        self.regions * self.side
    }

    /// Returns the coordinates that the window of a region shows. The border of the frame is
    /// repeated.
    fn window_coordinates(&self, region: usize) -> impl Iterator<Item = usize> + use<> {
        let (first, halo, last) = (region * self.side, self.halo, self.size() - 1);
        (first..first + self.side + 2 * halo).map(move |at| at.saturating_sub(halo).min(last))
    }
}

impl RasterFeedFrame {
    pub(super) fn new(design: SerialDesign<'_>) -> Self {
        let columns = GridAxis::new(design, design.columns(), |x| design.column_places(x));
        let rows = GridAxis::new(design, design.rows(), |y| design.row_places(y));
        Self { pixels: vec![0; columns.size() * rows.size()], columns, rows }
    }

    pub(super) fn pixels(&self) -> usize {
        self.pixels.len()
    }

    /// Writes pixel number `at` of the frame, and returns the number of places where the array
    /// stores it.
    pub(super) fn write(&mut self, at: usize, pixel: u16) -> u64 {
        self.pixels[at] = pixel;
        self.clocks(at)
    }

    /// Returns the number of clocks for which the pixels from number `at` on are written.
    pub(super) fn clocks_from(&self, at: usize) -> u64 {
        (at..self.pixels.len()).map(|at| self.clocks(at)).sum()
    }

    /// Returns the number of clocks for which pixel number `at` is written.
    fn clocks(&self, at: usize) -> u64 {
        let width = self.columns.size();
        u64::from(self.columns.place_counts[at % width])
            * u64::from(self.rows.place_counts[at / width])
    }

    pub(super) fn stream(&self, region: usize, out: &mut Vec<u16>) {
        let (column, row) = self.place(region);
        for y in self.rows.window_coordinates(row) {
            let line = &self.pixels[y * self.columns.size()..];
            out.extend(self.columns.window_coordinates(column).map(|x| line[x]));
        }
    }

    /// Returns the column and the row of a region in the grid.
    fn place(&self, region: usize) -> (usize, usize) {
        (region % self.columns.regions, region / self.columns.regions)
    }
}
