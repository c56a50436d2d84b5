// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbered PNG files in a folder of their own.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError};

use super::cannot_write;
use super::crew::Crew;
use super::gallery::{Picture, Samples};
use crate::SimulatorError;

/// A folder of pictures `000000.png`, `000001.png` and on.
pub(super) struct PngSeries {
    folder: PathBuf,
    next: u64,
    pub(super) crew: Crew,
}

impl PngSeries {
    pub(super) fn create(folder: PathBuf) -> Result<Self, SimulatorError> {
        fs::create_dir(&folder).map_err(cannot_write(&folder))?;
        Ok(Self { folder, next: 0, crew: Crew::new()? })
    }

    pub(super) fn push(&mut self, picture: Picture) {
        let path = self.folder.join(format!("{:06}.png", self.next));
        self.next += 1;
        self.crew.push(path, picture);
    }
}

/// At most how many bytes the pictures need that are on their way, of `samples` bytes per pixel.
pub(super) fn owed(width: u32, height: u32, samples: u64) -> u64 {
    // No PNG is longer than its pixels by more than a byte per row, some per block, and the frame.
    let picture = (u64::from(width) * samples + 1) * u64::from(height);
    (picture + picture / 1000 + 4096) * Crew::on_the_way() as u64
}

/// Writes one picture at once, by way of `bytes`.
pub(super) fn write(path: &Path, picture: &Picture, bytes: &mut Vec<u8>) -> io::Result<()> {
    let colour = match picture.samples {
        Samples::Grey8 => ExtendedColorType::L8,
        // The encoder takes native order and writes what PNG wants.
        Samples::Grey16 => ExtendedColorType::L16,
        Samples::Rgb8 => ExtendedColorType::Rgb8,
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

/// An 8-bit value as a byte.
pub(super) fn low_byte(value: u16) -> u8 {
    u8::try_from(value).unwrap_or(u8::MAX)
}
