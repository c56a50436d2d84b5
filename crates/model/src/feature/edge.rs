// SPDX-License-Identifier: MIT OR Apache-2.0
//! The feature `edge`: pixels whose 3x3 Sobel magnitude `|Gx| + |Gy|` is above a level.

use crate::window::PixelWindow;

/// Returns the Sobel magnitude `|Gx| + |Gy|` of the center.
///
/// ```text
///      -1  0 +1          -1 -2 -1
/// Gx:  -2  0 +2     Gy:   0  0  0
///      -1  0 +1          +1 +2 +1
/// ```
#[must_use]
pub fn edge_magnitude(window: &PixelWindow) -> u32 {
    let [nw, n, ne, w, _, e, sw, s, se] = *window;
    let side = |a: u16, b: u16, c: u16| i32::from(a) + 2 * i32::from(b) + i32::from(c);
    let gx = side(ne, e, se) - side(nw, w, sw);
    let gy = side(sw, s, se) - side(nw, n, ne);
    gx.unsigned_abs() + gy.unsigned_abs()
}
