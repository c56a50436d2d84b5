// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rectangles of real coordinates: pixel x covers x to x + 1.

/// The largest coordinate and side, in pixels.
pub const MAX_COORDINATE: f64 = 1e7;

/// A rectangle; `x1` and `y1` are where it ends, so that its width is `x1 - x0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Left side.
    pub x0: f64,
    /// Upper side.
    pub y0: f64,
    /// Right side.
    pub x1: f64,
    /// Lower side.
    pub y1: f64,
}

impl Rect {
    /// From two corners.
    ///
    /// # Errors
    /// When they are in the wrong order, no numbers, or out of range; the text says what is wrong.
    pub fn of_corners([x0, y0, x1, y1]: [f64; 4]) -> Result<Self, String> {
        for value in [x0, y0, x1, y1] {
            // Not a number is out of range, too.
            if !(-MAX_COORDINATE..=MAX_COORDINATE).contains(&value) {
                return Err(format!(
                    "the coordinate {value} is out of range; expected at most {MAX_COORDINATE} pixels"
                ));
            }
        }
        if x1 < x0 || y1 < y0 {
            return Err(format!(
                "the box from ({x0}, {y0}) to ({x1}, {y1}) ends before it begins; expected its upper left \
                 corner first"
            ));
        }
        Ok(Self { x0, y0, x1, y1 })
    }

    /// From a corner and the sides.
    ///
    /// # Errors
    /// When a side is negative, or a number is out of range; the text says what is wrong.
    pub fn of_sides([x, y, width, height]: [f64; 4]) -> Result<Self, String> {
        if width < 0.0 || height < 0.0 {
            return Err(format!(
                "the box is {width} x {height} pixels; expected sides of at least 0"
            ));
        }
        Self::of_corners([x, y, x + width, y + height])
    }

    /// Width.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.x1 - self.x0
    }

    /// Height.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.y1 - self.y0
    }

    /// Area in pixels.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.width() * self.height()
    }

    /// The middle.
    #[must_use]
    pub fn centre(&self) -> (f64, f64) {
        (f64::midpoint(self.x0, self.x1), f64::midpoint(self.y0, self.y1))
    }

    /// The part that lies in a frame of this size; without an area if nothing does.
    #[must_use]
    pub fn within(&self, (width, height): (u32, u32)) -> Self {
        let (width, height) = (f64::from(width), f64::from(height));
        Self {
            x0: self.x0.clamp(0.0, width),
            y0: self.y0.clamp(0.0, height),
            x1: self.x1.clamp(0.0, width),
            y1: self.y1.clamp(0.0, height),
        }
    }

    /// The rectangle at another scale.
    #[must_use]
    pub fn scaled(&self, x: f64, y: f64) -> Self {
        Self { x0: self.x0 * x, y0: self.y0 * y, x1: self.x1 * x, y1: self.y1 * y }
    }

    /// The rectangle at another place.
    #[must_use]
    pub fn moved(&self, x: f64, y: f64) -> Self {
        Self { x0: self.x0 + x, y0: self.y0 + y, x1: self.x1 + x, y1: self.y1 + y }
    }
}
