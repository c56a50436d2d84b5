// SPDX-License-Identifier: MIT OR Apache-2.0
//! 3x3 windows, and what they see beyond the border of their region.

use foveate_camera::{Camera, Neighborhood};

use crate::number::index;
use crate::region::Area;
use foveate_frame::Frame;

/// Nine pixels, row by row; the center is number 4.
pub type Window = [u16; 9];

/// Number of the center in a [`Window`].
pub const CENTER: usize = 4;

/// The rectangle that windows must not leave; a position outside is moved to the nearest inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) left: u32,
    pub(crate) top: u32,
    /// Last column.
    pub(crate) right: u32,
    /// Last row.
    pub(crate) bottom: u32,
}

impl Bounds {
    /// Columns left of, at and right of `x`, and rows above, at and below `y`. The position itself
    /// must be inside.
    pub(crate) fn around(self, x: u32, y: u32) -> ([u32; 3], [u32; 3]) {
        let columns = [x.saturating_sub(1).max(self.left), x, (x + 1).min(self.right)];
        let rows = [y.saturating_sub(1).max(self.top), y, (y + 1).min(self.bottom)];
        (columns, rows)
    }
}

/// One region of a padded frame with what its windows see around it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionView<'a> {
    frame: &'a Frame,
    area: Area,
    bounds: Bounds,
}

impl<'a> RegionView<'a> {
    /// Region `region` of a padded frame.
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
        Self { frame, area, bounds }
    }

    /// The region's pixels, row by row.
    pub(crate) fn pixels(self) -> impl Iterator<Item = u16> + 'a {
        self.area.pixels(self.frame)
    }

    /// The windows around the region's pixels, row by row.
    pub(crate) fn windows(self) -> impl Iterator<Item = Window> + 'a {
        self.area.positions().map(move |(x, y)| self.window(x, y))
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
