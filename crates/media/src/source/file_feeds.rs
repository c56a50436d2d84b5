// SPDX-License-Identifier: MIT OR Apache-2.0
//! Image files and scenes as feeds.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use foveate_pixels::{Scene, SceneFrames, SceneParameters};

use super::feed::FrameFeed;
use super::set_form::{SetFiles, SetForm, SetLabels};
use super::{SourceFrame, SourceKind};
use crate::picture::{self, ImageConversion};
use crate::{FootageError, FrameRate, InputOptions};

/// An image file, with the label that its folder gives it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ImageFile {
    pub(crate) path: PathBuf,
    pub(crate) label: Option<String>,
}

impl ImageFile {
    /// Makes an entry for a file without a label.
    pub(crate) fn plain(path: PathBuf) -> Self {
        Self { path, label: None }
    }
}

/// Returns the bytes of an image, by its number among the files and by its path.
pub(crate) type ImageBytes = Box<dyn FnMut(usize, &Path) -> Result<Vec<u8>, FootageError> + Send>;

/// A feed of images in a given order, which are files or lie in an archive.
pub(crate) struct ImageFiles {
    files: std::iter::Enumerate<std::vec::IntoIter<ImageFile>>,
    bytes_of: ImageBytes,
    total: u64,
    bits: u32,
    rate: FrameRate,
    kind: SourceKind,
    labels: SetLabels,
    conversion: ImageConversion,
}

impl ImageFiles {
    pub(crate) fn new(
        files: Vec<ImageFile>,
        bytes_of: ImageBytes,
        bits: u32,
        options: &InputOptions,
        kind: SourceKind,
    ) -> Self {
        let total = files.len() as u64;
        let names: BTreeSet<&String> =
            files.iter().filter_map(|file| file.label.as_ref()).collect();
        let labels = if names.is_empty() {
            SetLabels::None
        } else {
            SetLabels::Names(names.into_iter().cloned().collect())
        };
        Self {
            files: files.into_iter().enumerate(),
            bytes_of,
            total,
            bits,
            rate: options.frame_rate,
            kind,
            labels,
            conversion: ImageConversion::from_options(options),
        }
    }
}

impl FrameFeed for ImageFiles {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        let Some((number, ImageFile { path, label })) = self.files.next() else {
            return Ok(None);
        };
        let bytes = (self.bytes_of)(number, &path)?;
        let frame = (&picture::decode_converted(&bytes, &path, self.bits, self.conversion)?).into();
        let time_us = self.kind.time_us(self.rate, number as u64);
        Ok(Some(SourceFrame { name: path.display().to_string(), time_us, label, frame }))
    }

    fn total(&self) -> Option<u64> {
        Some(self.total)
    }

    fn kind(&self) -> SourceKind {
        self.kind
    }

    fn is_file_per_frame(&self) -> bool {
        true
    }

    fn takes_timestamps(&self) -> bool {
        true
    }

    fn reads_mosaics(&self) -> bool {
        true
    }

    fn form(&self) -> SetForm {
        SetForm { files: SetFiles::Images, labels: self.labels.clone() }
    }
}

pub(crate) struct SceneFeed {
    name: String,
    total: u64,
    frames: SceneFrames,
    next: u64,
    rate: FrameRate,
}

impl SceneFeed {
    pub(crate) fn new(scene: Scene, size: SceneParameters, rate: FrameRate) -> Self {
        let (name, total) = (format!("scene:{scene}"), size.frames.into());
        Self { name, total, frames: scene.frames(size), next: 0, rate }
    }
}

impl FrameFeed for SceneFeed {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        let time_us = self.rate.time_us(self.next);
        self.next += 1;
        let name = self.name.clone();
        let frame = self.frames.next();
        Ok(frame.map(|frame| SourceFrame { name, time_us, label: None, frame: (&frame).into() }))
    }

    fn total(&self) -> Option<u64> {
        Some(self.total)
    }
}
