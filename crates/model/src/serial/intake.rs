// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pixels of a frame as they are taken, and the stream of each region.

use foveate_design::{PixelFeed, SerialDesign};

use super::lane_streams::LaneStreams;
use super::raster_feed::RasterFeedFrame;

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

    /// Returns the number of pixels of the pixel port.
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
