// SPDX-License-Identifier: MIT OR Apache-2.0
//! A frame in the form that video has, which is a byte per pixel for up to 8 bits and a word for
//! more. With this form, video from a pipe reaches the engine without a conversion or a copy.

use crate::{Frame, FrameError, convert_depth, index};

/// The borrowed pixels of a frame or of a screen, in row-major order and without padding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FramePixels<'a> {
    /// Pixels of up to 8 bits.
    Bytes(&'a [u8]),
    /// Pixels of 9 to 16 bits.
    Words(&'a [u16]),
}

impl FramePixels<'_> {
    /// Copies the pixels into words, as [`Frame`] holds them.
    #[must_use]
    pub fn to_words(self) -> Vec<u16> {
        match self {
            Self::Bytes(pixels) => pixels.iter().map(|&pixel| pixel.into()).collect(),
            Self::Words(pixels) => pixels.to_vec(),
        }
    }

    /// Appends pixels of `bits` bits as 8-bit grey, one byte per pixel, the form that a browser
    /// draws.
    pub fn append_grey(self, bits: u32, grey: &mut Vec<u8>) {
        let grey_value = |pixel: u16| convert_depth(pixel, bits, 8).to_le_bytes()[0];
        match self {
            Self::Bytes(pixels) if bits == 8 => grey.extend_from_slice(pixels),
            Self::Bytes(pixels) => {
                grey.extend(pixels.iter().map(|&pixel| grey_value(pixel.into())));
            }
            Self::Words(pixels) => grey.extend(pixels.iter().map(|&pixel| grey_value(pixel))),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum ByteFrameStorage {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
}

/// A frame that owns its pixels. Every value has been checked to fit into the frame's bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ByteFrame {
    width: u32,
    height: u32,
    bits: u32,
    storage: ByteFrameStorage,
}

impl ByteFrame {
    /// Makes a frame of up to 8 bits per pixel from pixels in row-major order.
    ///
    /// # Errors
    /// Fails as [`Frame::new`] does, and if `bits` is above 8.
    pub fn from_bytes(
        width: u32,
        height: u32,
        bits: u32,
        pixels: Vec<u8>,
    ) -> Result<Self, FrameError> {
        check_size(width, height, pixels.len())?;
        if !(1..=8).contains(&bits) {
            return Err(FrameError::PixelBits { bits });
        }
        // With 8 bits every byte is in range, so only fewer bits need a check.
        if bits < 8 {
            check_values(width, bits, &pixels)?;
        }
        Ok(Self { width, height, bits, storage: ByteFrameStorage::Bytes(pixels) })
    }

    /// Makes a frame of any depth from pixels in row-major order.
    ///
    /// # Errors
    /// The errors are those of [`Frame::new`].
    pub fn from_words(
        width: u32,
        height: u32,
        bits: u32,
        pixels: Vec<u16>,
    ) -> Result<Self, FrameError> {
        check_size(width, height, pixels.len())?;
        if !(1..=16).contains(&bits) {
            return Err(FrameError::PixelBits { bits });
        }
        check_values(width, bits, &pixels)?;
        Ok(Self { width, height, bits, storage: store_pixels(bits, pixels) })
    }

    /// Returns the width in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the height in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the number of bits per pixel.
    #[must_use]
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// Borrows the pixels.
    #[must_use]
    pub fn borrowed_pixels(&self) -> FramePixels<'_> {
        match &self.storage {
            ByteFrameStorage::Bytes(pixels) => FramePixels::Bytes(pixels),
            ByteFrameStorage::Words(pixels) => FramePixels::Words(pixels),
        }
    }

    /// Returns the pixel at column `x` and row `y`.
    ///
    /// # Panics
    /// Panics if the position is outside of the frame.
    #[must_use]
    pub fn get(&self, x: u32, y: u32) -> u16 {
        assert!(x < self.width, "column {x} of a frame {} pixels wide", self.width);
        let place = index(y) * index(self.width) + index(x);
        match &self.storage {
            ByteFrameStorage::Bytes(pixels) => pixels[place].into(),
            ByteFrameStorage::Words(pixels) => pixels[place],
        }
    }

    /// Copies the frame into the type that the model takes.
    ///
    /// # Errors
    /// The errors are those of [`Frame::new`]. A frame that has been checked has none of them.
    pub fn to_frame(&self) -> Result<Frame, FrameError> {
        Frame::new(self.width, self.height, self.bits, self.borrowed_pixels().to_words())
    }

    /// Returns the buffer of a frame of bytes, so that it can be used again, and `None` for a frame
    /// of words.
    #[must_use]
    pub fn into_bytes(self) -> Option<Vec<u8>> {
        match self.storage {
            ByteFrameStorage::Bytes(pixels) => Some(pixels),
            ByteFrameStorage::Words(_) => None,
        }
    }
}

impl From<&Frame> for ByteFrame {
    fn from(frame: &Frame) -> Self {
        let (width, height, bits) = (frame.width(), frame.height(), frame.bits());
        Self { width, height, bits, storage: store_pixels(bits, frame.pixels().to_vec()) }
    }
}

/// Stores checked pixels as bytes if `bits` is at most 8, otherwise as words.
fn store_pixels(bits: u32, pixels: Vec<u16>) -> ByteFrameStorage {
    if bits > 8 {
        return ByteFrameStorage::Words(pixels);
    }
    ByteFrameStorage::Bytes(
        pixels.into_iter().map(|pixel| u8::try_from(pixel).expect("up to 8 bits")).collect(),
    )
}

fn check_size(width: u32, height: u32, given: usize) -> Result<(), FrameError> {
    if width == 0 || height == 0 {
        return Err(FrameError::EmptyFrame { width, height });
    }
    let needed = u64::from(width) * u64::from(height);
    if u64::try_from(given) != Ok(needed) {
        return Err(FrameError::FrameLength { width, height, needed, given });
    }
    Ok(())
}

fn check_values<T: Copy + Ord + Into<u16>>(
    width: u32,
    bits: u32,
    pixels: &[T],
) -> Result<(), FrameError> {
    let max = u16::MAX >> (16 - bits);
    let largest = pixels.iter().copied().max().expect("a frame has pixels").into();
    if largest <= max {
        return Ok(());
    }
    let place = pixels.iter().position(|&pixel| pixel.into() > max).expect("the largest is above");
    let coordinate =
        |place: usize| u32::try_from(place).expect("a frame has its width and height in 32 bits");
    let (x, y) = (coordinate(place % index(width)), coordinate(place / index(width)));
    Err(FrameError::PixelRange { x, y, value: pixels[place].into(), bits, max })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_from_bytes_and_from_words_are_equal() {
        let bytes = ByteFrame::from_bytes(3, 2, 4, vec![0, 1, 2, 3, 4, 15]).unwrap();
        let words = ByteFrame::from_words(3, 2, 4, vec![0, 1, 2, 3, 4, 15]).unwrap();
        assert_eq!(bytes, words);
        assert_eq!((bytes.get(2, 1), bytes.get(1, 0)), (15, 1));
        assert_eq!(ByteFrame::from(&bytes.to_frame().unwrap()), bytes);
        assert_eq!(bytes.into_bytes(), Some(vec![0, 1, 2, 3, 4, 15]));
        let deep = ByteFrame::from_words(1, 2, 12, vec![4095, 7]).unwrap();
        assert_eq!(deep.borrowed_pixels(), FramePixels::Words(&[4095, 7]));
        assert_eq!(ByteFrame::from(&deep.to_frame().unwrap()), deep);
        assert_eq!(deep.into_bytes(), None);
    }

    #[test]
    fn both_constructors_refuse_the_same_pixels() {
        for (width, height, bits, pixels) in [
            (0, 3, 8, vec![]),
            (1, 1, 0, vec![0]),
            (1, 1, 17, vec![0]),
            (3, 2, 8, vec![0; 5]),
            (2, 2, 3, vec![7, 0, 8, 9]),
        ] {
            let expected = Frame::new(width, height, bits, pixels.clone()).unwrap_err();
            let bytes = pixels.iter().map(|&pixel| u8::try_from(pixel).unwrap()).collect();
            assert_eq!(ByteFrame::from_bytes(width, height, bits, bytes), Err(expected.clone()));
            assert_eq!(ByteFrame::from_words(width, height, bits, pixels), Err(expected));
        }
        let deep = ByteFrame::from_bytes(1, 1, 9, vec![0]);
        assert_eq!(deep, Err(FrameError::PixelBits { bits: 9 }));
    }
}
