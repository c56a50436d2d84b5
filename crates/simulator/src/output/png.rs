// SPDX-License-Identifier: MIT OR Apache-2.0
//! PNG files of pictures.

use std::fs;
use std::io;
use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError};

use super::raw_image::{RawImage, SampleFormat};

/// Encodes a picture into `bytes` and writes it to a file at once.
pub(super) fn write(path: &Path, picture: &RawImage, bytes: &mut Vec<u8>) -> io::Result<()> {
    let colour = match picture.samples {
        SampleFormat::Grey8 => ExtendedColorType::L8,
        // The encoder takes the byte order of the machine, and writes that of PNG.
        SampleFormat::Grey16 => ExtendedColorType::L16,
        SampleFormat::Rgb8 => ExtendedColorType::Rgb8,
    };
    bytes.clear();
    PngEncoder::new_with_quality(&mut *bytes, CompressionType::Fast, FilterType::Paeth)
        .write_image(&picture.bytes, picture.width, picture.height, colour)
        .map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => io::Error::other(other),
        })?;
    fs::write(path, bytes)
}
