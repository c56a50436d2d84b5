// SPDX-License-Identifier: MIT OR Apache-2.0
//! Rectangles with real coordinates. The pixel in column x covers x to x + 1.

/// The largest absolute value of a coordinate, in pixels.
pub const MAX_COORDINATE: f64 = 1e7;

/// A rectangle. `x1` and `y1` are its exclusive ends, so that its width is `x1 - x0`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rect {
    /// The coordinate of the left side.
    pub x0: f64,
    /// The coordinate of the upper side.
    pub y0: f64,
    /// The coordinate of the right side.
    pub x1: f64,
    /// The coordinate of the lower side.
    pub y1: f64,
}

impl Rect {
    /// Makes a rectangle from its upper left and its lower right corner.
    ///
    /// # Errors
    /// Fails if the corners are in the wrong order, not numbers, or out of range. The text says
    /// what is wrong.
    pub fn from_corners([x0, y0, x1, y1]: [f64; 4]) -> Result<Self, String> {
        for value in [x0, y0, x1, y1] {
            // This test also refuses NaN.
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

    /// Makes a rectangle from its upper left corner, its width and its height.
    ///
    /// # Errors
    /// Fails if a side is negative, or a number is out of range. The text says what is wrong.
    pub fn from_corner_and_size([x, y, width, height]: [f64; 4]) -> Result<Self, String> {
        if width < 0.0 || height < 0.0 {
            return Err(format!(
                "the box is {width} x {height} pixels; expected sides of at least 0"
            ));
        }
        Self::from_corners([x, y, x + width, y + height])
    }

    /// Returns the width in pixels.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.x1 - self.x0
    }

    /// Returns the height in pixels.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.y1 - self.y0
    }

    /// Returns the area in pixels.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.width() * self.height()
    }

    /// Returns the coordinates of the middle.
    #[must_use]
    pub fn centre(&self) -> (f64, f64) {
        (f64::midpoint(self.x0, self.x1), f64::midpoint(self.y0, self.y1))
    }

    /// Returns the part of the rectangle that lies in a frame of this size. Its area is 0 if no
    /// part does.
    #[must_use]
    pub fn cropped_to_frame(&self, (width, height): (u32, u32)) -> Self {
        let (width, height) = (f64::from(width), f64::from(height));
        Self {
            x0: self.x0.clamp(0.0, width),
            y0: self.y0.clamp(0.0, height),
            x1: self.x1.clamp(0.0, width),
            y1: self.y1.clamp(0.0, height),
        }
    }

    /// Returns the rectangle with its x coordinates multiplied by `x` and its y coordinates by `y`.
    #[must_use]
    pub fn scaled(&self, x: f64, y: f64) -> Self {
        Self { x0: self.x0 * x, y0: self.y0 * y, x1: self.x1 * x, y1: self.y1 * y }
    }

    /// Returns the rectangle moved by `x` to the right and by `y` downwards.
    #[must_use]
    pub fn moved(&self, x: f64, y: f64) -> Self {
        Self { x0: self.x0 + x, y0: self.y0 + y, x1: self.x1 + x, y1: self.y1 + y }
    }
}
