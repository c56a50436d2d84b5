// SPDX-License-Identifier: MIT OR Apache-2.0
//! The images of a ZIP archive as a feed.

use std::collections::BTreeSet;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::zip_listing::{OpenArchive, ZipImage, open_archive, zip_error, zip_images};
use crate::limits::MAX_FILE_GIB;
use crate::options::ImageRelation;
use crate::picture::{self, ImageConversion};
use crate::source::feed::FrameFeed;
use crate::source::set_form::{SetFiles, SetForm, SetLabels};
use crate::{FootageError, FrameRate, InputOptions, SourceFrame, SourceKind};

/// A feed of the images of an archive.
pub(crate) struct ZipImages {
    path: PathBuf,
    archive: OpenArchive,
    images: std::vec::IntoIter<ZipImage>,
    total: u64,
    next: u64,
    bits: u32,
    rate: FrameRate,
    kind: SourceKind,
    labels: SetLabels,
    conversion: ImageConversion,
}

impl ZipImages {
    pub(crate) fn open(
        path: &Path,
        bits: u32,
        options: &InputOptions,
    ) -> Result<Self, FootageError> {
        let archive = open_archive(path)?;
        let images = zip_images(path, &archive, options.images)?;
        let kind = match options.images {
            ImageRelation::Set => SourceKind::Set,
            ImageRelation::Clip | ImageRelation::CifarSheet => SourceKind::Clip,
        };
        let names: BTreeSet<String> =
            images.iter().filter_map(|image| image.label.clone()).collect();
        let labels = match names.is_empty() {
            true => SetLabels::None,
            false => SetLabels::Names(names.into_iter().collect()),
        };
        Ok(Self {
            path: path.to_owned(),
            archive,
            total: images.len() as u64,
            images: images.into_iter(),
            next: 0,
            bits,
            rate: options.frame_rate,
            kind,
            labels,
            conversion: ImageConversion::from_options(options),
        })
    }

    /// Returns the bytes of an image. Their checksum is compared with that of the archive.
    fn bytes_of(&mut self, image: &ZipImage, name: &Path) -> Result<Vec<u8>, FootageError> {
        let limit = MAX_FILE_GIB << 30;
        let shown = image.path.display().to_string();
        let entry = self.archive.by_index(image.index);
        let entry = entry.map_err(|error| zip_error(&self.path, &shown, &error))?;
        let mut bytes = Vec::new();
        let read = entry.take(limit + 1).read_to_end(&mut bytes);
        read.map_err(|error| zip_error(&self.path, &shown, &error.into()))?;
        if bytes.len() as u64 > limit {
            return Err(FootageError::TooLarge { path: name.to_owned() });
        }
        Ok(bytes)
    }
}

impl FrameFeed for ZipImages {
    fn next(&mut self) -> Result<Option<SourceFrame>, FootageError> {
        let Some(image) = self.images.next() else { return Ok(None) };
        let name = self.path.join(&image.path);
        let bytes = self.bytes_of(&image, &name)?;
        let frame = picture::decode_converted(&bytes, &name, self.bits, self.conversion)?;
        let time_us = self.kind.time_us(self.rate, self.next);
        self.next += 1;
        let name = name.display().to_string();
        Ok(Some(SourceFrame { name, time_us, label: image.label, frame: (&frame).into() }))
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

    fn form(&self) -> SetForm {
        SetForm { files: SetFiles::Images, labels: self.labels.clone() }
    }

    fn takes_timestamps(&self) -> bool {
        true
    }

    fn reads_mosaics(&self) -> bool {
        true
    }
}
