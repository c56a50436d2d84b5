// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame: width x height luma pixels of 1 to 16 bits each, in row-major order.

use crate::{FrameError, index};

/// The pixels of one frame. Every value has been checked to fit into the frame's bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    width: u32,
    height: u32,
    bits: u32,
    pixels: Vec<u16>,
}

impl Frame {
    /// Makes a frame from its pixels in row-major order.
    ///
    /// # Errors
    /// Fails if a side is zero, `bits` is not in `1..=16`, the number of pixels is not
    /// `width * height`, or a pixel does not fit into `bits` bits.
    pub fn new(width: u32, height: u32, bits: u32, pixels: Vec<u16>) -> Result<Self, FrameError> {
        if width == 0 || height == 0 {
            return Err(FrameError::EmptyFrame { width, height });
        }
        if !(1..=16).contains(&bits) {
            return Err(FrameError::PixelBits { bits });
        }
        let needed = u64::from(width) * u64::from(height);
        if u64::try_from(pixels.len()) != Ok(needed) {
            let given = pixels.len();
            return Err(FrameError::FrameLength { width, height, needed, given });
        }
        let frame = Self { width, height, bits, pixels };
        match frame.find_pixel_out_of_range() {
            None => Ok(frame),
            Some((x, y, value, max)) => Err(FrameError::PixelRange { x, y, value, bits, max }),
        }
    }

    /// Makes a frame whose pixels are all `value`.
    ///
    /// # Errors
    /// The errors are those of [`Frame::new`].
    pub fn filled(width: u32, height: u32, bits: u32, value: u16) -> Result<Self, FrameError> {
        Self::from_fn(width, height, bits, |_, _| value)
    }

    /// Makes a frame whose pixel at column `x` and row `y` is `f(x, y)`.
    ///
    /// # Errors
    /// The errors are those of [`Frame::new`].
    pub fn from_fn(
        width: u32,
        height: u32,
        bits: u32,
        mut f: impl FnMut(u32, u32) -> u16,
    ) -> Result<Self, FrameError> {
        let mut pixels = Vec::new();
        for y in 0..height {
            pixels.extend((0..width).map(|x| f(x, y)));
        }
        Self::new(width, height, bits, pixels)
    }

    /// Returns the width in pixels.
    #[inline]
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height in pixels.
    #[inline]
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the number of bits per pixel.
    #[inline]
    #[must_use]
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// Returns every pixel in row-major order.
    #[inline]
    #[must_use]
    pub fn pixels(&self) -> &[u16] {
        &self.pixels
    }

    /// Returns the pixel at column `x` and row `y`.
    ///
    /// # Panics
    /// Panics if the position is outside of the frame.
    #[inline]
    #[must_use]
    pub fn get(&self, x: u32, y: u32) -> u16 {
        self.row(y)[index(x)]
    }

    /// Returns the pixel of the frame that is nearest to column `x` and row `y`.
    #[inline]
    #[must_use]
    pub fn get_clamped(&self, x: i64, y: i64) -> u16 {
        let nearest = |at: i64, size: u32| {
            u32::try_from(at.clamp(0, i64::from(size) - 1)).expect("clamped to the frame")
        };
        self.get(nearest(x, self.width), nearest(y, self.height))
    }

    /// Returns the pixels of row `y`.
    ///
    /// # Panics
    /// Panics if the row is outside of the frame.
    #[inline]
    #[must_use]
    pub fn row(&self, y: u32) -> &[u16] {
        &self.pixels[index(y) * index(self.width)..][..index(self.width)]
    }

    /// Writes pixels into row `y`, starting at column `x`.
    ///
    /// # Panics
    /// Panics if the pixels reach beyond the row, or if one of them does not fit into the frame's
    /// bits.
    #[inline]
    pub fn write_row(&mut self, x: u32, y: u32, pixels: &[u16]) {
        let max = u16::MAX >> (16 - self.bits);
        assert!(pixels.iter().all(|&pixel| pixel <= max), "a pixel above {max} in row {y}");
        let from = index(y) * index(self.width);
        let row = &mut self.pixels[from..from + index(self.width)];
        row[index(x)..][..pixels.len()].copy_from_slice(pixels);
    }

    /// Writes the pixel at column `x` and row `y`.
    ///
    /// # Panics
    /// Panics if the position is outside of the frame, or if the pixel does not fit into the
    /// frame's bits.
    pub fn set(&mut self, x: u32, y: u32, pixel: u16) {
        let max = u16::MAX >> (16 - self.bits);
        assert!(pixel <= max, "a pixel above {max} in row {y}");
        let from = index(y) * index(self.width);
        self.pixels[from..from + index(self.width)][index(x)] = pixel;
    }

    /// Returns the size and the depth as an error message names them.
    #[must_use]
    pub fn size_and_depth(&self) -> String {
        format!("{}x{} pixels of {} bits", self.width, self.height, self.bits)
    }

    /// Returns column, row and value of the first pixel that does not fit into its bits, and the
    /// largest value that fits.
    fn find_pixel_out_of_range(&self) -> Option<(u32, u32, u16, u16)> {
        let max = u16::MAX >> (16 - self.bits);
        (0..self.height).find_map(|y| {
            let too_large = |(x, &value): (u32, &u16)| (value > max).then_some((x, y, value, max));
            (0..self.width).zip(self.row(y)).find_map(too_large)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_names_what_makes_pixels_no_frame() {
        assert_eq!(Frame::filled(0, 3, 8, 0), Err(FrameError::EmptyFrame { width: 0, height: 3 }));
        assert_eq!(Frame::filled(1, 1, 17, 0), Err(FrameError::PixelBits { bits: 17 }));
        assert_eq!(Frame::filled(1, 1, 0, 0), Err(FrameError::PixelBits { bits: 0 }));
        let message = Frame::new(3, 2, 8, vec![0; 5]).unwrap_err().to_string();
        assert_eq!(message, "a frame of 3x2 needs 6 pixels, but 5 were given");
        let message = Frame::new(2, 2, 3, vec![7, 0, 8, 0]).unwrap_err().to_string();
        assert_eq!(message, "pixel (0, 1) is 8; the largest value of 3 bits is 7");
        assert!(Frame::filled(2, 2, 16, u16::MAX).is_ok());
        assert!(Frame::filled(2, 2, 1, 1).is_ok());
    }

    #[test]
    fn written_pixels_stay_in_their_row() {
        let mut frame = Frame::filled(3, 2, 4, 0).unwrap();
        frame.write_row(1, 1, &[15, 7]);
        frame.set(2, 0, 9);
        assert_eq!(frame.pixels(), [0, 0, 9, 0, 15, 7]);
    }

    #[test]
    #[should_panic(expected = "a pixel above 15 in row 0")]
    fn a_value_of_too_many_bits_is_not_written() {
        Frame::filled(3, 2, 4, 0).unwrap().write_row(0, 0, &[16]);
    }

    #[test]
    #[should_panic(expected = "a pixel above 15 in row 1")]
    fn a_pixel_of_too_many_bits_is_not_written() {
        Frame::filled(3, 2, 4, 0).unwrap().set(0, 1, 16);
    }

    #[test]
    #[should_panic(expected = "out of range")]
    fn no_pixel_is_written_beyond_its_row() {
        Frame::filled(3, 2, 4, 0).unwrap().write_row(2, 0, &[1, 1]);
    }

    #[test]
    #[should_panic(expected = "out of bounds")]
    fn no_single_pixel_is_written_beyond_its_row() {
        Frame::filled(3, 2, 4, 0).unwrap().set(3, 0, 1);
    }

    #[test]
    fn positions_outside_hold_the_nearest_pixel() {
        let frame = Frame::from_fn(3, 2, 8, |x, y| u16::try_from(10 * y + x).unwrap()).unwrap();
        assert_eq!((frame.get(2, 1), frame.row(1)), (12, &[10, 11, 12][..]));
        assert_eq!(
            [(-1, -9), (7, -1), (1, 9), (9, 9)].map(|(x, y)| frame.get_clamped(x, y)),
            [0, 2, 11, 12]
        );
    }
}
