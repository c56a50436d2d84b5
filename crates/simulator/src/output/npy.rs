// SPDX-License-Identifier: MIT OR Apache-2.0
//! NumPy files (NPY 1.0) that grow frame by frame: the header has room for any number of frames and
//! gets the real one at the end.

use std::marker::PhantomData;
use std::path::Path;

use super::growing::GrowingFile;
use crate::SimulatorError;

/// Bytes of the header; a multiple of 64 that holds the largest numbers.
const HEADER: usize = 128;

/// A type that NumPy knows.
pub(super) trait Scalar: Copy {
    /// Its name, with its byte order.
    const DESCR: &'static str;
    fn append_to(self, bytes: &mut Vec<u8>);
}

impl Scalar for u8 {
    const DESCR: &'static str = "|u1";
    fn append_to(self, bytes: &mut Vec<u8>) {
        bytes.push(self);
    }
}

impl Scalar for u32 {
    const DESCR: &'static str = "<u4";
    fn append_to(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl Scalar for u64 {
    const DESCR: &'static str = "<u8";
    fn append_to(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl Scalar for i64 {
    const DESCR: &'static str = "<i8";
    fn append_to(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

/// An array of frames x rows x columns, or of one value per frame.
pub(super) struct NpyWriter<T> {
    file: GrowingFile,
    /// The other dimensions, as they are written.
    shape: String,
    frames: u64,
    scalar: PhantomData<T>,
}

impl<T: Scalar> NpyWriter<T> {
    pub(super) fn create(path: &Path, rows: u32, columns: u32) -> Result<Self, SimulatorError> {
        Self::with_shape(path, format!(" {rows}, {columns}"))
    }

    /// An array of one dimension.
    pub(super) fn create_list(path: &Path) -> Result<Self, SimulatorError> {
        Self::with_shape(path, String::new())
    }

    fn with_shape(path: &Path, shape: String) -> Result<Self, SimulatorError> {
        let file = GrowingFile::create(path)?;
        let mut writer = Self { file, shape, frames: 0, scalar: PhantomData };
        let header = writer.header();
        writer.file.append(&header);
        Ok(writer)
    }

    /// Appends the values of one frame, row by row.
    pub(super) fn push(&mut self, values: impl Iterator<Item = T>) {
        for value in values {
            value.append_to(self.file.end());
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
        header::<HEADER>(&format!("'{}'", T::DESCR), &shape)
    }
}

/// A header of `SIZE` bytes, a multiple of 64: a type and a shape as Python writes them.
pub(super) fn header<const SIZE: usize>(descr: &str, shape: &str) -> Vec<u8> {
    const PREFIX: usize = 10;
    let length = u16::try_from(SIZE - PREFIX).unwrap_or(u16::MAX);
    let dictionary = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({shape}), }}");
    let padded = format!("{dictionary:<0$}\n", SIZE - PREFIX - 1);
    [b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], padded.as_bytes()].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

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
