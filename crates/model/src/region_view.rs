// SPDX-License-Identifier: MIT OR Apache-2.0
//! The view of a region that every score is computed from: its pixels, the windows around them, and
//! its reference. A new score can use all of it.

use foveate_camera::{Camera, Neighborhood};

use crate::conversions::index;
use crate::region::RegionArea;
use crate::window::{PixelWindow, WindowBounds};
use foveate_pixels::Frame;

/// The denoised pixels of a region and of its reference, in row-major order.
pub trait RegionView {
    /// Returns the number of pixels of the region, n.
    fn pixel_count(&self) -> u64;
    /// Returns the pixels of the region.
    fn pixels(&self) -> impl Iterator<Item = u16>;
    /// Returns the window around each pixel of the region.
    fn windows(&self) -> impl Iterator<Item = PixelWindow>;
    /// Returns the pixels of the reference, or `None` if there is no valid one.
    fn reference(&self) -> Option<impl Iterator<Item = u16>>;
}

/// A region in its padded frame, with its reference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameRegion<'a> {
    frame: &'a Frame,
    area: RegionArea,
    bounds: WindowBounds,
    reference: Option<&'a Frame>,
}

impl<'a> FrameRegion<'a> {
    /// Makes a view of region `region` of a padded frame, without a reference.
    pub(crate) fn new(camera: &Camera, frame: &'a Frame, region: u32) -> Self {
        let area = RegionArea::from_region(camera, region);
        let bounds = match camera.neighborhood() {
            Neighborhood::Isolated => WindowBounds {
                left: area.left,
                top: area.top,
                right: area.left + area.side - 1,
                bottom: area.top + area.side - 1,
            },
            Neighborhood::Shared => WindowBounds {
                left: 0,
                top: 0,
                right: frame.width() - 1,
                bottom: frame.height() - 1,
            },
        };
        Self { frame, area, bounds, reference: None }
    }

    /// Adds the padded frame that holds the reference of the region.
    pub(crate) fn with_reference(self, reference: Option<&'a Frame>) -> Self {
        Self { reference, ..self }
    }

    /// Returns the window around one pixel of the region.
    pub(crate) fn window(self, x: u32, y: u32) -> PixelWindow {
        let (columns, rows) = self.bounds.neighbors(x, y);
        let mut window = [0; 9];
        for (line, y) in window.chunks_exact_mut(3).zip(rows) {
            let row = self.frame.row(y);
            for (pixel, x) in line.iter_mut().zip(columns) {
                *pixel = row[index(x)];
            }
        }
        window
    }
}

impl RegionView for FrameRegion<'_> {
    fn pixel_count(&self) -> u64 {
        u64::from(self.area.side).pow(2)
    }

    fn pixels(&self) -> impl Iterator<Item = u16> {
        self.area.pixels(self.frame)
    }

    fn windows(&self) -> impl Iterator<Item = PixelWindow> {
        let region = *self;
        region.area.positions().map(move |(x, y)| region.window(x, y))
    }

    fn reference(&self) -> Option<impl Iterator<Item = u16>> {
        self.reference.map(|frame| self.area.pixels(frame))
    }
}
