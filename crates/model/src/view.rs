// SPDX-License-Identifier: MIT OR Apache-2.0
//! What there is to see of a region: what stands there now, with the windows around it, and what stood there before.
//! Whatever scores a region takes this, so that a new score can look at all of it.

use foveate_camera::{Camera, Neighborhood};

use crate::number::index;
use crate::region::Area;
use crate::window::{Bounds, Window};
use foveate_frame::Frame;

/// What there is to see of a region, all of it denoised and row by row.
pub trait RegionView {
    /// How many pixels it has, n.
    fn n(&self) -> u64;
    /// Its pixels.
    fn pixels(&self) -> impl Iterator<Item = u16>;
    /// The window around each of them.
    fn windows(&self) -> impl Iterator<Item = Window>;
    /// What it is compared with: the pixels of its reference; `None` where there is no valid one.
    fn before(&self) -> Option<impl Iterator<Item = u16>>;
}

/// A region in its padded frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameRegion<'a> {
    frame: &'a Frame,
    area: Area,
    bounds: Bounds,
    reference: Option<&'a Frame>,
}

impl<'a> FrameRegion<'a> {
    /// Region `region` of a padded frame, without a reference.
    pub(crate) fn new(camera: &Camera, frame: &'a Frame, region: u32) -> Self {
        let area = Area::of(camera, region);
        let bounds = match camera.neighborhood() {
            Neighborhood::Isolated => Bounds {
                left: area.left,
                top: area.top,
                right: area.left + area.side - 1,
                bottom: area.top + area.side - 1,
            },
            Neighborhood::Shared => {
                Bounds { left: 0, top: 0, right: frame.width() - 1, bottom: frame.height() - 1 }
            }
        };
        Self { frame, area, bounds, reference: None }
    }

    /// The same, to be compared with what stands there in another padded frame.
    pub(crate) fn after(self, reference: Option<&'a Frame>) -> Self {
        Self { reference, ..self }
    }

    /// The window around one pixel of the region.
    pub(crate) fn window(self, x: u32, y: u32) -> Window {
        let (columns, rows) = self.bounds.around(x, y);
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
    fn n(&self) -> u64 {
        u64::from(self.area.side).pow(2)
    }

    fn pixels(&self) -> impl Iterator<Item = u16> {
        self.area.pixels(self.frame)
    }

    fn windows(&self) -> impl Iterator<Item = Window> {
        let region = *self;
        region.area.positions().map(move |(x, y)| region.window(x, y))
    }

    fn before(&self) -> Option<impl Iterator<Item = u16>> {
        self.reference.map(|frame| self.area.pixels(frame))
    }
}
