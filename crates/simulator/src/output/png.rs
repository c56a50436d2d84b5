// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbered PNG files in a folder of their own.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError};

use super::cannot_write;
use super::gallery::{Picture, Samples};
use crate::SimulatorError;

/// A folder of pictures `000000.png`, `000001.png` and on.
pub(super) struct PngSeries {
    folder: PathBuf,
    next: u64,
}

impl PngSeries {
    pub(super) fn create(folder: PathBuf) -> Result<Self, SimulatorError> {
        fs::create_dir(&folder).map_err(cannot_write(&folder))?;
        Ok(Self { folder, next: 0 })
    }

    pub(super) fn push(&mut self, picture: &Picture) -> Result<(), SimulatorError> {
        let path = self.folder.join(format!("{:06}.png", self.next));
        self.next += 1;
        File::create(&path).and_then(|file| encode(file, picture)).map_err(cannot_write(&path))
    }
}

/// Writes one picture to a new file.
pub(super) fn encode(file: File, picture: &Picture) -> io::Result<()> {
    let colour = match picture.samples {
        Samples::Grey8 => ExtendedColorType::L8,
        // The encoder takes native order and writes what PNG wants.
        Samples::Grey16 => ExtendedColorType::L16,
        Samples::Rgb8 => ExtendedColorType::Rgb8,
    };
    let mut file = BufWriter::new(file);
    PngEncoder::new_with_quality(&mut file, CompressionType::Fast, FilterType::Adaptive)
        .write_image(&picture.bytes, picture.width, picture.height, colour)
        .map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => io::Error::other(other),
        })?;
    file.flush()
}

/// An 8-bit value as a byte.
pub(super) fn low_byte(value: u16) -> u8 {
    u8::try_from(value).unwrap_or(u8::MAX)
}
