// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbered PNG files in a folder of their own.

use std::fs;
use std::path::{Path, PathBuf};

use super::cannot_write;
use super::png_writers::PngWriters;
use super::raw_image::RawImage;
use crate::SimulatorError;

/// A folder of pictures `000000.png`, `000001.png` and so on.
pub(super) struct PngSeries {
    folder: PathBuf,
    next: u64,
    pub(super) writers: PngWriters,
}

impl PngSeries {
    pub(super) fn create(folder: PathBuf) -> Result<Self, SimulatorError> {
        fs::create_dir(&folder).map_err(cannot_write(&folder))?;
        Ok(Self { folder, next: 0, writers: PngWriters::new()? })
    }

    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    pub(super) fn push(&mut self, picture: RawImage) {
        let path = self.folder.join(format!("{:06}.png", self.next));
        self.next += 1;
        self.writers.push(path, picture);
    }
}
