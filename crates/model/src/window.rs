// SPDX-License-Identifier: MIT OR Apache-2.0
//! 3x3 windows, and what they see beyond the border of their region.

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
