// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbered PNG files in a folder of their own.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use foveate_model::Frame;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError};

use super::cannot_write;
use crate::{SimulatorError, convert_depth, display_depth};

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

    /// Writes a grey frame at the depth that [`display_depth`] gives it.
    pub(super) fn push_frame(&mut self, frame: &Frame) -> Result<(), SimulatorError> {
        let depth = display_depth(frame.bits());
        let values = frame.pixels().iter().map(|&value| convert_depth(value, frame.bits(), depth));
        let (bytes, colour) = if depth == 8 {
            (values.map(low_byte).collect::<Vec<u8>>(), ExtendedColorType::L8)
        } else {
            // The encoder takes native order and writes what PNG wants.
            (values.flat_map(u16::to_ne_bytes).collect(), ExtendedColorType::L16)
        };
        self.push(&bytes, frame.width(), frame.height(), colour)
    }

    /// Writes an 8-bit colour picture.
    pub(super) fn push_colour(
        &mut self,
        rgb: &[u8],
        width: u32,
        height: u32,
    ) -> Result<(), SimulatorError> {
        self.push(rgb, width, height, ExtendedColorType::Rgb8)
    }

    fn push(
        &mut self,
        bytes: &[u8],
        width: u32,
        height: u32,
        colour: ExtendedColorType,
    ) -> Result<(), SimulatorError> {
        let path = self.folder.join(format!("{:06}.png", self.next));
        self.next += 1;
        write(&path, bytes, width, height, colour).map_err(cannot_write(&path))
    }
}

fn write(
    path: &Path,
    bytes: &[u8],
    width: u32,
    height: u32,
    colour: ExtendedColorType,
) -> io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    PngEncoder::new_with_quality(&mut file, CompressionType::Fast, FilterType::Adaptive)
        .write_image(bytes, width, height, colour)
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
