// SPDX-License-Identifier: MIT OR Apache-2.0
//! The images of a ZIP archive as a feed.

use std::io::Read;
use std::path::Path;

use super::zip_listing::{OpenArchive, ZipImage, open_archive, zip_error, zip_images};
use crate::limits::MAX_FILE_GIB;
use crate::options::ImageRelation;
use crate::source::file_feeds::{ImageFile, ImageFiles};
use crate::{FootageError, InputOptions, SourceKind};

/// Opens the images of an archive.
pub(super) fn open_zip(
    path: &Path,
    bits: u32,
    options: &InputOptions,
) -> Result<ImageFiles, FootageError> {
    let mut archive = open_archive(path)?;
    let images = zip_images(path, &archive, options.images)?;
    let kind = match options.images {
        ImageRelation::Set => SourceKind::Set,
        ImageRelation::Clip | ImageRelation::CifarSheet => SourceKind::Clip,
    };
    let file =
        |image: &ZipImage| ImageFile { path: path.join(&image.path), label: image.label.clone() };
    let files = images.iter().map(file).collect();
    let own_path = path.to_owned();
    let bytes_of = move |number: usize, name: &Path| {
        entry_bytes((&own_path, &mut archive), &images[number], name)
    };
    Ok(ImageFiles::new(files, Box::new(bytes_of), bits, options, kind))
}

/// Returns the bytes of an image. Their checksum is compared with that of the archive.
fn entry_bytes(
    (path, archive): (&Path, &mut OpenArchive),
    image: &ZipImage,
    name: &Path,
) -> Result<Vec<u8>, FootageError> {
    let limit = MAX_FILE_GIB << 30;
    let shown = image.path.display().to_string();
    let entry = archive.by_index(image.index);
    let entry = entry.map_err(|error| zip_error(path, &shown, &error))?;
    let mut bytes = Vec::new();
    let read = entry.take(limit + 1).read_to_end(&mut bytes);
    read.map_err(|error| zip_error(path, &shown, &error.into()))?;
    if bytes.len() as u64 > limit {
        return Err(FootageError::TooLarge { path: name.to_owned() });
    }
    Ok(bytes)
}
