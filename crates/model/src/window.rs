// SPDX-License-Identifier: MIT OR Apache-2.0
//! Windows of 3x3 pixels, and the pixels that they see beyond the border of their region.

/// Nine pixels in row-major order. The center has number 4.
pub type PixelWindow = [u16; 9];

/// Number of the center in a [`PixelWindow`].
pub const CENTER: usize = 4;

/// The rectangle that windows must not leave. A position outside of it is moved to the nearest one
/// inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WindowBounds {
    pub(crate) left: u32,
    pub(crate) top: u32,
    /// Last column of the rectangle.
    pub(crate) right: u32,
    /// Last row of the rectangle.
    pub(crate) bottom: u32,
}

impl WindowBounds {
    /// Returns the columns left of, at and right of `x`, and the rows above, at and below `y`. The
    /// position itself must be inside of the rectangle.
    pub(crate) fn neighbors(self, x: u32, y: u32) -> ([u32; 3], [u32; 3]) {
        let columns = [x.saturating_sub(1).max(self.left), x, (x + 1).min(self.right)];
        let rows = [y.saturating_sub(1).max(self.top), y, (y + 1).min(self.bottom)];
        (columns, rows)
    }
}
