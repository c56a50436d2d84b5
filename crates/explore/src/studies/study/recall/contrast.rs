// SPDX-License-Identifier: MIT OR Apache-2.0
//! The contrast of an object: the mean of the pixels in its box against the mean of a ring around
//! it.

use foveate_pixels::{ByteFrame, Rect};

/// The summed-area table of a frame: the sum of all pixels above and to the left of every corner.
/// The sum of any rectangle takes four of its entries.
pub(super) struct SummedAreaTable {
    width: u32,
    height: u32,
    /// The largest value of a pixel.
    max: u64,
    sums: Vec<u64>,
}

/// A rectangle of whole pixels; `x1` and `y1` are not part of it.
#[derive(Clone, Copy)]
struct PixelRect {
    x0: u32,
    y0: u32,
    x1: u32,
    y1: u32,
}

impl PixelRect {
    fn area(self) -> u64 {
        u64::from(self.x1 - self.x0) * u64::from(self.y1 - self.y0)
    }
}

impl SummedAreaTable {
    pub(super) fn from_frame(frame: &ByteFrame) -> Self {
        let (width, height) = (frame.width(), frame.height());
        let columns = width as usize;
        let mut sums = vec![0; columns + 1];
        for row in frame.borrowed_pixels().to_words().chunks_exact(columns) {
            let above = sums.len() - (columns + 1);
            let mut left = 0;
            sums.push(0);
            for (column, &pixel) in row.iter().enumerate() {
                left += u64::from(pixel);
                sums.push(left + sums[above + column + 1]);
            }
        }
        Self { width, height, max: (1 << frame.bits()) - 1, sums }
    }

    /// Returns the difference of the means in grey levels of 8 bits. The ring is a quarter of the
    /// shorter side wide, at least one pixel, and ends at the border of the frame. Returns `None`
    /// if the ring is empty.
    pub(super) fn contrast(&self, rect: &Rect) -> Option<f64> {
        let (x0, x1) = whole_pixels(rect.x0, rect.x1, self.width);
        let (y0, y1) = whole_pixels(rect.y0, rect.y1, self.height);
        let wide = ((x1 - x0).min(y1 - y0) / 4).max(1);
        let inner = PixelRect { x0, y0, x1, y1 };
        let outer = PixelRect {
            x0: x0.saturating_sub(wide),
            y0: y0.saturating_sub(wide),
            x1: (x1 + wide).min(self.width),
            y1: (y1 + wide).min(self.height),
        };
        let ring = outer.area() - inner.area();
        if ring == 0 {
            return None;
        }
        let inside = self.sum(inner);
        let difference = mean(inside, inner.area()) - mean(self.sum(outer) - inside, ring);
        Some(difference.abs() * 255.0 / mean(self.max, 1))
    }

    fn sum(&self, part: PixelRect) -> u64 {
        let at = |x: u32, y: u32| self.sums[y as usize * (self.width as usize + 1) + x as usize];
        at(part.x1, part.y1) + at(part.x0, part.y0) - at(part.x0, part.y1) - at(part.x1, part.y0)
    }
}

#[allow(clippy::cast_precision_loss, reason = "exact up to 2^53")]
fn mean(sum: u64, count: u64) -> f64 {
    sum as f64 / count as f64
}

/// Rounds the ends of a side to whole pixels within a frame of `size` pixels; the side has at least
/// one pixel.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the frame")]
fn whole_pixels(from: f64, to: f64, size: u32) -> (u32, u32) {
    let first = (from.round() as u32).min(size - 1);
    (first, (to.round() as u32).clamp(first + 1, size))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computes the contrast from the pixels themselves.
    fn naive_contrast(frame: &ByteFrame, [x0, y0, x1, y1]: [u32; 4], wide: u32) -> f64 {
        let (mut inside, mut ring) = ((0, 0), (0, 0));
        for y in y0.saturating_sub(wide)..(y1 + wide).min(frame.height()) {
            for x in x0.saturating_sub(wide)..(x1 + wide).min(frame.width()) {
                let own = (x0..x1).contains(&x) && (y0..y1).contains(&y);
                let sum = if own { &mut inside } else { &mut ring };
                *sum = (sum.0 + u32::from(frame.get(x, y)), sum.1 + 1);
            }
        }
        let mean = |(sum, count): (u32, u32)| f64::from(sum) / f64::from(count);
        (mean(inside) - mean(ring)).abs()
    }

    #[test]
    fn contrast_is_that_of_the_pixels() {
        let bytes = (0..40 * 30).map(|at: u32| u8::try_from(at * at % 251).unwrap()).collect();
        let frame = ByteFrame::from_bytes(40, 30, 8, bytes).unwrap();
        let sums = SummedAreaTable::from_frame(&frame);
        let contrast =
            |corners: [f64; 4]| sums.contrast(&Rect::from_corners(corners).unwrap()).unwrap();
        for (corners, pixels, wide) in [
            ([10., 8., 22., 20.], [10, 8, 22, 20], 3),
            ([0., 0., 5., 30.], [0, 0, 5, 30], 1),
            ([36.4, 27.6, 40., 30.], [36, 28, 40, 30], 1),
            ([7.2, 7.2, 7.3, 7.3], [7, 7, 8, 8], 1),
            ([39.9, 29.9, 40., 30.], [39, 29, 40, 30], 1),
        ] {
            let (found, expected) = (contrast(corners), naive_contrast(&frame, pixels, wide));
            assert!((found - expected).abs() < 1e-9, "{corners:?}: {found}, not {expected}");
        }
        assert_eq!(sums.contrast(&Rect::from_corners([0., 0., 40., 30.]).unwrap()), None);
    }

    #[test]
    fn levels_are_those_of_8_bits() {
        let words = (0..64).map(|at| if at % 8 < 4 { 15 } else { 0 }).collect();
        let sums = SummedAreaTable::from_frame(&ByteFrame::from_words(8, 8, 4, words).unwrap());
        let rect = Rect::from_corners([0., 0., 4., 8.]).unwrap();
        assert_eq!(sums.contrast(&rect), Some(255.0));
    }
}
