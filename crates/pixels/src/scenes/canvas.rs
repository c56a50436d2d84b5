// SPDX-License-Identifier: MIT OR Apache-2.0
//! A 16-bit grey canvas with anti-aliased shapes, which are drawn in units that do not depend on
//! its size.
//!
//! The canvas is always [`UNITS_HIGH`] units high. Its width in units follows from its aspect
//! ratio. A unit has 64 parts, and all coordinates are in parts. Sixteen samples per pixel smooth
//! the borders of shapes.

/// Height of every canvas in units.
pub(crate) const UNITS_HIGH: i64 = 224;
/// Number of parts of a unit.
pub(crate) const UNIT: i64 = 64;
/// Number of samples of a pixel along each axis.
const SAMPLES: i64 = 4;
/// Opacity of a shape that hides everything below it.
pub(crate) const OPAQUE: u32 = 256;

/// A grey canvas. Black is 0 and white is 65535.
#[derive(Clone, Debug)]
pub(crate) struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<u16>,
}

/// The bounding rectangle of a shape in parts of units, right and bottom excluded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeBounds {
    pub(crate) left: i64,
    pub(crate) top: i64,
    pub(crate) right: i64,
    pub(crate) bottom: i64,
}

impl Canvas {
    pub(crate) fn new(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![0; width as usize * height as usize] }
    }

    pub(crate) fn get(&self, x: u32, y: u32) -> u16 {
        let index = y as usize * self.width as usize + x as usize;
        self.pixels[index]
    }

    /// Returns the width of the canvas in parts of units.
    pub(crate) fn parts_wide(&self) -> i64 {
        i64::from(self.width) * UNITS_HIGH * UNIT / i64::from(self.height)
    }

    /// Blends `shade` into every sample that is within `bounds` and for which `inside` returns
    /// true.
    pub(crate) fn fill(
        &mut self,
        bounds: ShapeBounds,
        shade: u16,
        opacity: u32,
        inside: impl Fn(i64, i64) -> bool,
    ) {
        let (columns, rows) = self.pixel_ranges(bounds);
        let full_weight = OPAQUE * 16;
        for y in rows {
            for x in columns.clone() {
                let covered = self.covered_samples(x, y, bounds, &inside);
                if covered == 0 {
                    continue;
                }
                let weight = (opacity * covered).min(full_weight);
                let index = y as usize * self.width as usize + x as usize;
                if let Some(pixel) = self.pixels.get_mut(index) {
                    let sum =
                        u32::from(*pixel) * (full_weight - weight) + u32::from(shade) * weight;
                    *pixel = u16::try_from(sum / full_weight).expect("a mean of two shades");
                }
            }
        }
    }

    /// Returns the number of samples of a pixel, 0..=16, that are within `bounds` and for which
    /// `inside` returns true.
    fn covered_samples(
        &self,
        x: u32,
        y: u32,
        bounds: ShapeBounds,
        inside: &impl Fn(i64, i64) -> bool,
    ) -> u32 {
        let mut covered = 0;
        for sample_y in 0..SAMPLES {
            let v = self.sample_center(i64::from(y) * SAMPLES + sample_y);
            for sample_x in 0..SAMPLES {
                let u = self.sample_center(i64::from(x) * SAMPLES + sample_x);
                covered += u32::from(bounds.contains(u, v) && inside(u, v));
            }
        }
        covered
    }

    /// Returns the center of a sample in parts of units.
    fn sample_center(&self, sample: i64) -> i64 {
        (2 * sample + 1) * UNITS_HIGH * UNIT / (2 * SAMPLES * i64::from(self.height))
    }

    fn pixel_ranges(&self, bounds: ShapeBounds) -> (std::ops::Range<u32>, std::ops::Range<u32>) {
        let parts_high = UNITS_HIGH * UNIT;
        let pixel = |parts: i64| parts * i64::from(self.height) / parts_high;
        let clamp = |pixel: i64, max: u32| {
            u32::try_from(pixel.clamp(0, i64::from(max)))
                .expect("between 0 and the side of a canvas")
        };
        (
            clamp(pixel(bounds.left) - 1, self.width)..clamp(pixel(bounds.right) + 2, self.width),
            clamp(pixel(bounds.top) - 1, self.height)..clamp(pixel(bounds.bottom) + 2, self.height),
        )
    }
}

impl ShapeBounds {
    fn contains(self, u: i64, v: i64) -> bool {
        (self.left..self.right).contains(&u) && (self.top..self.bottom).contains(&v)
    }
}

/// A painter of shapes in whole units around an origin. It can mirror them, and dims them at night.
pub(crate) struct ShapePainter<'a> {
    pub(crate) canvas: &'a mut Canvas,
    /// Position of the origin (0, 0) in parts of units.
    pub(crate) origin: (i64, i64),
    /// Direction of x: 1, or -1 to mirror left and right.
    pub(crate) facing: i64,
    /// Brightness of daylight in 256ths.
    pub(crate) light: u32,
}

impl ShapePainter<'_> {
    /// Paints a rectangle that reflects daylight. `shade` is an 8-bit grey level.
    pub(crate) fn rect(&mut self, left: i64, top: i64, right: i64, bottom: i64, shade: u32) {
        let bounds = self.bounds(left, top, right, bottom);
        let shade = self.reflected_shade(shade);
        self.canvas.fill(bounds, shade, OPAQUE, |_, _| true);
    }

    /// Paints a rectangle whose shade does not depend on daylight: a light or a shadow.
    pub(crate) fn glow_rect(&mut self, at: [i64; 4], shade: u32, opacity: u32) {
        let [left, top, right, bottom] = at;
        let bounds = self.bounds(left, top, right, bottom);
        self.canvas.fill(bounds, emitted_shade(shade), opacity, |_, _| true);
    }

    /// Paints a disc that reflects daylight. The radius is in parts of units.
    pub(crate) fn disc(&mut self, x: i64, y: i64, radius: i64, shade: u32) {
        let shade = self.reflected_shade(shade);
        self.fill_disc(x, y, radius, shade, OPAQUE);
    }

    /// Paints a disc whose shade does not depend on daylight.
    pub(crate) fn glow_disc(&mut self, x: i64, y: i64, radius: i64, shade: u32, opacity: u32) {
        self.fill_disc(x, y, radius, emitted_shade(shade), opacity);
    }

    /// Paints a convex polygon that reflects daylight. Its corners are in parts of units from the
    /// origin, in clockwise or counterclockwise order.
    pub(crate) fn polygon(&mut self, corners: &[(i64, i64)], shade: u32) {
        let shade = self.reflected_shade(shade);
        self.fill_polygon(corners, shade, OPAQUE);
    }

    /// Paints a convex polygon whose shade does not depend on daylight.
    pub(crate) fn glow_polygon(&mut self, corners: &[(i64, i64)], shade: u32, opacity: u32) {
        self.fill_polygon(corners, emitted_shade(shade), opacity);
    }

    fn fill_disc(&mut self, x: i64, y: i64, radius: i64, shade: u16, opacity: u32) {
        let (cx, cy) = self.canvas_position(x * UNIT, y * UNIT);
        let bounds = ShapeBounds {
            left: cx - radius,
            top: cy - radius,
            right: cx + radius,
            bottom: cy + radius,
        };
        self.canvas.fill(bounds, shade, opacity, |u, v| {
            (u - cx) * (u - cx) + (v - cy) * (v - cy) <= radius * radius
        });
    }

    fn fill_polygon(&mut self, corners: &[(i64, i64)], shade: u16, opacity: u32) {
        const CORNERS: &str = "a polygon has corners";
        let corners: Vec<_> = corners.iter().map(|&(x, y)| self.canvas_position(x, y)).collect();
        let xs = corners.iter().map(|corner| corner.0);
        let ys = corners.iter().map(|corner| corner.1);
        let bounds = ShapeBounds {
            left: xs.clone().min().expect(CORNERS),
            top: ys.clone().min().expect(CORNERS),
            right: xs.max().expect(CORNERS),
            bottom: ys.max().expect(CORNERS),
        };
        let next = corners.iter().cycle().skip(1);
        let sides: Vec<_> = corners.iter().zip(next).collect();
        self.canvas.fill(bounds, shade, opacity, |u, v| {
            // A point is inside if it lies on the same side of every edge.
            let cross_product = |(a, b): &(&(i64, i64), &(i64, i64))| {
                (b.0 - a.0) * (v - a.1) - (b.1 - a.1) * (u - a.0)
            };
            sides.iter().all(|side| cross_product(side) >= 0)
                || sides.iter().all(|side| cross_product(side) <= 0)
        });
    }

    fn bounds(&self, left: i64, top: i64, right: i64, bottom: i64) -> ShapeBounds {
        let (a, top) = self.canvas_position(left * UNIT, top * UNIT);
        let (b, bottom) = self.canvas_position(right * UNIT, bottom * UNIT);
        ShapeBounds { left: a.min(b), top, right: a.max(b), bottom }
    }

    fn canvas_position(&self, x: i64, y: i64) -> (i64, i64) {
        (self.origin.0 + self.facing * x, self.origin.1 + y)
    }

    fn reflected_shade(&self, shade: u32) -> u16 {
        u16::try_from(shade * 257 * self.light / 256).unwrap_or(u16::MAX)
    }
}

fn emitted_shade(shade: u32) -> u16 {
    u16::try_from(shade * 257).unwrap_or(u16::MAX)
}
