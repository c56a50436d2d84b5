// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame as the pixel port takes it.

use foveate_design::{Feed as Order, SerialDesign};
use foveate_frame::Frame;
use foveate_model::region_stream;

/// A frame as the pixel port takes it, and the streams of its regions.
pub(crate) struct Feed {
    /// Pixels that the port takes at once.
    width: usize,
    pixels: Vec<u16>,
    /// One stream per region, one after the other.
    streams: Vec<u16>,
    stream_pixels: usize,
}

impl Feed {
    /// The frame for a design of its size. What the port shows for empty slots is `nothing`.
    pub(crate) fn of(
        design: SerialDesign<'_>,
        frame: &Frame,
        nothing: impl FnMut() -> u16,
    ) -> Self {
        let mut streams = Vec::new();
        for region in 0..design.regions() {
            region_stream(&design, frame, region, &mut streams);
        }
        let stream_pixels = design.stream_pixels() as usize;
        let (width, pixels) = match design.feed() {
            Order::Raster => (1, raster(design, frame)),
            Order::Parallel => {
                let lanes = design.lanes() as usize;
                (lanes, parallel(design, &streams, nothing))
            }
        };
        Self { width, pixels, streams, stream_pixels }
    }

    /// What is at the port for each pixel of the frame.
    pub(crate) fn beats(&self) -> impl Iterator<Item = &[u16]> {
        self.pixels.chunks_exact(self.width)
    }

    /// How many times the port takes something.
    pub(super) fn count(&self) -> usize {
        self.pixels.len() / self.width
    }

    /// The raw pixels of a region with its halo.
    pub(super) fn stream(&self, region: usize) -> &[u16] {
        &self.streams[region * self.stream_pixels..][..self.stream_pixels]
    }
}

/// The padded frame, row by row.
fn raster(design: SerialDesign<'_>, frame: &Frame) -> Vec<u16> {
    let side = i64::from(design.region_size());
    let (width, height) = (i64::from(design.columns()) * side, i64::from(design.rows()) * side);
    let row = |y| (0..width).map(move |x| frame.clamped(x, y));
    (0..height).flat_map(row).collect()
}

/// The stream of slot 0 of every lane, then that of slot 1, ...
fn parallel(
    design: SerialDesign<'_>,
    streams: &[u16],
    mut nothing: impl FnMut() -> u16,
) -> Vec<u16> {
    let (lanes, fold) = (design.lanes() as usize, design.fold() as usize);
    let count = design.stream_pixels() as usize;
    let mut pixels = Vec::with_capacity(fold * count * lanes);
    for slot in 0..fold {
        for at in 0..count {
            for lane in 0..lanes {
                let place = (lane * fold + slot) * count + at;
                pixels.push(streams.get(place).copied().unwrap_or_else(&mut nothing));
            }
        }
    }
    pixels
}
