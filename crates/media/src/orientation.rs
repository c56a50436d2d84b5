// SPDX-License-Identifier: MIT OR Apache-2.0
//! The orientation of frames: as they are stored, or upright.

use foveate_pixels::{ByteFrame, FrameError, FramePixels};

/// The orientation in which images and video are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Orientation {
    /// The rows and columns as they are stored. Marks of cameras and phones are ignored.
    #[default]
    Stored,
    /// Turned and mirrored as the mark in the file says: the EXIF orientation of images, the
    /// display matrix of video. A file without a mark is not changed.
    Upright,
}

impl Orientation {
    /// Returns the name in options.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Stored => "stored",
            Self::Upright => "upright",
        }
    }
}

/// A turn by a multiple of 90 degrees, with or without mirroring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct FrameTurn {
    /// True if rows become columns.
    is_transposed: bool,
    /// True if the stored columns, and the stored rows, are read from the last to the first.
    is_reversed: (bool, bool),
}

impl FrameTurn {
    /// Returns the turn of a matrix of signs `[a, b, c, d]`: the stored column x and row y become
    /// the column a x + c y and the row b x + d y. Returns `None` if the matrix is not such a turn.
    pub(crate) fn of_axes(signs: [i64; 4]) -> Option<Self> {
        let (is_transposed, column, row) = match signs {
            [a, 0, 0, d] if a != 0 && d != 0 => (false, a, d),
            [0, b, c, 0] if b != 0 && c != 0 => (true, b, c),
            _ => return None,
        };
        Some(Self { is_transposed, is_reversed: (column < 0, row < 0) })
    }

    pub(crate) fn turned(self, frame: ByteFrame) -> Result<ByteFrame, FrameError> {
        if self == Self::default() {
            return Ok(frame);
        }
        let stored = (frame.width(), frame.height());
        let (width, height) = if self.is_transposed { (stored.1, stored.0) } else { stored };
        let bits = frame.bits();
        match frame.borrowed_pixels() {
            FramePixels::Bytes(pixels) => {
                ByteFrame::from_bytes(width, height, bits, self.turned_pixels(pixels, stored))
            }
            FramePixels::Words(pixels) => {
                ByteFrame::from_words(width, height, bits, self.turned_pixels(pixels, stored))
            }
        }
    }

    fn turned_pixels<T: Copy>(self, pixels: &[T], (width, height): (u32, u32)) -> Vec<T> {
        let (width, height) = (width as usize, height as usize);
        let column = |x: usize| if self.is_reversed.0 { width - 1 - x } else { x };
        let row = |y: usize| if self.is_reversed.1 { height - 1 - y } else { y };
        let at = |x: usize, y: usize| pixels[row(y) * width + column(x)];
        match self.is_transposed {
            false => (0..height)
                .flat_map(|y| (0..width).map(move |x| (x, y)))
                .map(|(x, y)| at(x, y))
                .collect(),
            true => (0..width)
                .flat_map(|x| (0..height).map(move |y| (x, y)))
                .map(|(x, y)| at(x, y))
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_those_of_their_matrix() {
        let frame = || ByteFrame::from_bytes(3, 2, 8, vec![1, 2, 3, 4, 5, 6]).unwrap();
        for (signs, width, expected) in [
            ([1, 0, 0, 1], 3, [1, 2, 3, 4, 5, 6]),
            ([-1, 0, 0, 1], 3, [3, 2, 1, 6, 5, 4]),
            ([-1, 0, 0, -1], 3, [6, 5, 4, 3, 2, 1]),
            // The first row becomes the last column.
            ([0, 1, -1, 0], 2, [4, 1, 5, 2, 6, 3]),
            ([0, -1, 1, 0], 2, [3, 6, 2, 5, 1, 4]),
            ([0, 1, 1, 0], 2, [1, 4, 2, 5, 3, 6]),
        ] {
            let turned = FrameTurn::of_axes(signs).unwrap().turned(frame()).unwrap();
            assert_eq!(turned.width(), width);
            assert_eq!(turned.borrowed_pixels().to_words(), expected, "{signs:?}");
        }
        for signs in [[1, 1, -1, 1], [0, 0, 0, 0], [1, 0, 0, 0]] {
            assert_eq!(FrameTurn::of_axes(signs), None);
        }
    }
}
