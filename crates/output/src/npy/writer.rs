// SPDX-License-Identifier: MIT OR Apache-2.0
//! A NumPy file (NPY 1.0) that grows frame by frame ([`NpyWriter`]). Its header has room for
//! any number of frames, and gets the real number at the end. The values of the array are of
//! one [`ElementType`].

use foveate_tools::{GrowingFile, StagingError};
use std::path::Path;

/// The smallest header in bytes; headers grow in steps of 64.
const MIN_HEADER_BYTES: usize = 128;
/// The number of bytes before the text of a header.
const PREFIX_BYTES: usize = 10;

/// A file of an array of frames that all have the same shape.
#[derive(Debug)]
pub struct NpyWriter {
    file: GrowingFile,
    element: ElementType,
    /// The other dimensions, as they are written in the header.
    frame_shape: String,
    /// The number of bytes of the header, which has room for any number of frames.
    header_bytes: usize,
    frames: u64,
}

impl NpyWriter {
    /// Creates a file for an array of frames of this shape. With an empty shape a frame is one
    /// value.
    ///
    /// # Errors
    /// Fails if the file cannot be written.
    pub fn create(
        path: &Path,
        element: ElementType,
        shape: &[usize],
    ) -> Result<Self, StagingError> {
        let file = GrowingFile::create(path)?;
        let shape = shape.iter().map(|length| format!(" {length}")).collect::<Vec<_>>().join(",");
        // The header is measured with the largest number of frames, so that any number fits.
        let mut writer = Self {
            file,
            element,
            frame_shape: shape,
            header_bytes: MIN_HEADER_BYTES,
            frames: u64::MAX,
        };
        let needed_bytes = PREFIX_BYTES + writer.header_text().len() + 1;
        writer.header_bytes = needed_bytes.next_multiple_of(64).max(MIN_HEADER_BYTES);
        writer.frames = 0;
        let header = writer.header();
        writer.file.append(&header);
        Ok(writer)
    }

    /// Appends the values of one frame in row-major order. The type must hold all of them. Each
    /// value is given by its bits: signed integers in two's complement, floating-point numbers as
    /// by [`f32::to_bits`].
    pub fn push(&mut self, values: impl Iterator<Item = u64>) {
        let bytes = self.element.bytes();
        for value in values {
            debug_assert!(bytes == 8 || value >> (8 * bytes) == 0, "{value} in {:?}", self.element);
            self.file.append(&value.to_le_bytes()[..bytes]);
        }
        self.frames += 1;
    }

    /// Writes the pending bytes if there are many of them.
    ///
    /// # Errors
    /// Fails if the disk is full or the file cannot be written. Bytes that were not written are
    /// kept.
    pub fn write_pending(&mut self) -> Result<(), StagingError> {
        self.file.write_pending()
    }

    /// Writes the number of frames into the header.
    ///
    /// # Errors
    /// Fails like [`NpyWriter::write_pending`].
    pub fn finish(mut self) -> Result<(), StagingError> {
        let header = self.header();
        self.file.overwrite(0, &header)
    }

    fn header(&self) -> Vec<u8> {
        padded_header(self.header_bytes, &self.header_text())
    }

    fn header_text(&self) -> String {
        let shape = format!("{},{}", self.frames, self.frame_shape);
        header_text(&format!("'{}'", self.element.numpy_name()), &shape)
    }
}

/// Returns a header of `size` bytes, a multiple of 64, for a type and a shape in the notation of
/// Python.
#[must_use]
pub fn npy_header(size: usize, descr: &str, shape: &str) -> Vec<u8> {
    padded_header(size, &header_text(descr, shape))
}

/// Returns the text of a header, which is a dictionary in Python.
fn header_text(descr: &str, shape: &str) -> String {
    format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({shape}), }}")
}

fn padded_header(size: usize, text: &str) -> Vec<u8> {
    let length = u16::try_from(size - PREFIX_BYTES).expect("a header has a few bytes");
    let padded = format!("{text:<0$}\n", size - PREFIX_BYTES - 1);
    [b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], padded.as_bytes()].concat()
}

/// A little-endian type of elements that NumPy supports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementType {
    /// An unsigned integer of one byte, also used for truth values, 0 and 1.
    Unsigned8,
    /// A signed integer of one byte, in two's complement.
    Signed8,
    /// An unsigned integer of two bytes.
    Unsigned16,
    /// An unsigned integer of four bytes.
    Unsigned32,
    /// An unsigned integer of eight bytes.
    Unsigned64,
    /// A signed integer of eight bytes, in two's complement.
    Signed64,
    /// A floating-point number of four bytes (IEEE 754).
    Float32,
}

impl ElementType {
    /// Returns the smallest unsigned type that holds `0..=max`.
    #[must_use]
    pub fn smallest_for(max: u64) -> Self {
        match max {
            0..=0xFF => Self::Unsigned8,
            0x100..=0xFFFF => Self::Unsigned16,
            0x1_0000..=0xFFFF_FFFF => Self::Unsigned32,
            _ => Self::Unsigned64,
        }
    }

    pub(crate) fn numpy_name(self) -> &'static str {
        match self {
            Self::Unsigned8 => "|u1",
            Self::Signed8 => "|i1",
            Self::Unsigned16 => "<u2",
            Self::Unsigned32 => "<u4",
            Self::Unsigned64 => "<u8",
            Self::Signed64 => "<i8",
            Self::Float32 => "<f4",
        }
    }

    pub(crate) fn bytes(self) -> usize {
        match self {
            Self::Unsigned8 | Self::Signed8 => 1,
            Self::Unsigned16 => 2,
            Self::Unsigned32 | Self::Float32 => 4,
            Self::Unsigned64 | Self::Signed64 => 8,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_has_its_size_whatever_the_numbers_are() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("array.npy");
        for (shape, size) in [
            (vec![], 128),
            (vec![28, 28], 128),
            (vec![1, 3, 224, 224], 128),
            (vec![123_456_789; 8], 192),
        ] {
            let writer = NpyWriter::create(&path, ElementType::Float32, &shape).unwrap();
            for frames in [0, 7, u64::MAX] {
                let header = NpyWriter {
                    frames,
                    ..NpyWriter::create(&path, ElementType::Float32, &shape).unwrap()
                }
                .header();
                assert_eq!((header.len(), writer.header_bytes), (size, size), "{shape:?}");
                assert_eq!(usize::from(header[8]) + 256 * usize::from(header[9]) + 10, size);
                assert_eq!(header.last(), Some(&b'\n'));
            }
        }
    }

    /// The expected bytes follow the NPY format and are written by hand.
    #[test]
    fn frames_follow_the_header_and_are_counted_at_the_end() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("array.npy");
        let mut writer = NpyWriter::create(&path, ElementType::Float32, &[1, 2]).unwrap();
        for frame in [[1.0f32, -2.0], [f32::NAN, 0.5]] {
            writer.push(frame.iter().map(|value| value.to_bits().into()));
            writer.write_pending().unwrap();
        }
        writer.finish().unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let header = b"\x93NUMPY\x01\x00\x76\x00{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1, 2), }  ";
        assert!(bytes.starts_with(header), "{}", String::from_utf8_lossy(&bytes));
        let values: Vec<u32> = bytes[128..]
            .chunks(4)
            .map(|four| u32::from_le_bytes(four.try_into().unwrap()))
            .collect();
        assert_eq!(values, [0x3F80_0000, 0xC000_0000, f32::NAN.to_bits(), 0x3F00_0000]);
    }

    #[test]
    fn types_are_as_small_as_the_range_allows() {
        let descr = |max| ElementType::smallest_for(max).numpy_name();
        assert_eq!([0, 255, 256, 65_535].map(descr), ["|u1", "|u1", "<u2", "<u2"]);
        assert_eq!([65_536, u64::from(u32::MAX), 1 << 32].map(descr), ["<u4", "<u4", "<u8"]);
    }
}
