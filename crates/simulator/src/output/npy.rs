// SPDX-License-Identifier: MIT OR Apache-2.0
//! NumPy files (NPY 1.0) that grow frame by frame: the header has room for any number of frames and
//! gets the real one at the end.

use std::path::Path;

use super::growing::GrowingFile;
use crate::SimulatorError;

/// Bytes of the header; a multiple of 64 that holds the largest numbers.
const HEADER: usize = 128;

/// A type of elements that NumPy knows, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Element {
    Unsigned8,
    Unsigned16,
    Unsigned32,
    Unsigned64,
    Signed64,
}

impl Element {
    /// The smallest unsigned type that holds `0..=max`.
    pub(super) fn up_to(max: u64) -> Self {
        match max {
            0..=0xFF => Self::Unsigned8,
            0x100..=0xFFFF => Self::Unsigned16,
            0x1_0000..=0xFFFF_FFFF => Self::Unsigned32,
            _ => Self::Unsigned64,
        }
    }

    fn descr(self) -> &'static str {
        match self {
            Self::Unsigned8 => "|u1",
            Self::Unsigned16 => "<u2",
            Self::Unsigned32 => "<u4",
            Self::Unsigned64 => "<u8",
            Self::Signed64 => "<i8",
        }
    }

    fn bytes(self) -> usize {
        match self {
            Self::Unsigned8 => 1,
            Self::Unsigned16 => 2,
            Self::Unsigned32 => 4,
            Self::Unsigned64 | Self::Signed64 => 8,
        }
    }
}

/// An array of frames x rows x columns, or of one value per frame.
pub(super) struct NpyWriter {
    file: GrowingFile,
    element: Element,
    /// The other dimensions, as they are written.
    shape: String,
    frames: u64,
}

impl NpyWriter {
    pub(super) fn create(
        path: &Path,
        element: Element,
        rows: u32,
        columns: u32,
    ) -> Result<Self, SimulatorError> {
        Self::with_shape(path, element, format!(" {rows}, {columns}"))
    }

    /// An array of one dimension.
    pub(super) fn create_list(path: &Path, element: Element) -> Result<Self, SimulatorError> {
        Self::with_shape(path, element, String::new())
    }

    fn with_shape(path: &Path, element: Element, shape: String) -> Result<Self, SimulatorError> {
        let file = GrowingFile::create(path)?;
        let mut writer = Self { file, element, shape, frames: 0 };
        let header = writer.header();
        writer.file.append(&header);
        Ok(writer)
    }

    /// Appends the values of one frame, row by row; the type holds all of them, signed ones as two's
    /// complement.
    pub(super) fn push(&mut self, values: impl Iterator<Item = u64>) {
        let bytes = self.element.bytes();
        for value in values {
            debug_assert!(bytes == 8 || value >> (8 * bytes) == 0, "{value} in {:?}", self.element);
            self.file.append(&value.to_le_bytes()[..bytes]);
        }
        self.frames += 1;
    }

    pub(super) fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        self.file.write_out(all)
    }

    /// Writes the number of frames into the header.
    pub(super) fn finish(mut self) -> Result<(), SimulatorError> {
        let header = self.header();
        self.file.write_over(0, &header)
    }

    fn header(&self) -> Vec<u8> {
        let shape = format!("{},{}", self.frames, self.shape);
        header::<HEADER>(&format!("'{}'", self.element.descr()), &shape)
    }
}

/// A header of `SIZE` bytes, a multiple of 64: a type and a shape as Python writes them.
pub(super) fn header<const SIZE: usize>(descr: &str, shape: &str) -> Vec<u8> {
    const PREFIX: usize = 10;
    let length = u16::try_from(SIZE - PREFIX).expect("a header has a few bytes");
    let dictionary = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({shape}), }}");
    let padded = format!("{dictionary:<0$}\n", SIZE - PREFIX - 1);
    [b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], padded.as_bytes()].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_as_small_as_the_range_allows() {
        let descr = |max| Element::up_to(max).descr();
        assert_eq!([0, 255, 256, 65_535].map(descr), ["|u1", "|u1", "<u2", "<u2"]);
        assert_eq!([65_536, u64::from(u32::MAX), 1 << 32].map(descr), ["<u4", "<u4", "<u8"]);
    }

    #[test]
    fn a_header_has_its_size_whatever_the_numbers_are() {
        for (frames, side) in [(0u64, 1u32), (7, 28), (u64::MAX, u32::MAX)] {
            let shape = format!("{frames}, {side}, {side}");
            let header = header::<HEADER>("'<u8'", &shape);
            assert_eq!(header.len(), HEADER);
            assert_eq!(usize::from(header[8]) + 256 * usize::from(header[9]) + 10, HEADER);
            assert_eq!(header.last(), Some(&b'\n'));
        }
    }
}
